#include "glocal/pose_cells.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "glocal/rng.hpp"

namespace glocal {

std::size_t hash_of(std::span<const std::int64_t> numbers) {
  std::uint64_t hash = 0;
  for (const std::int64_t number : numbers) hash = mix64(hash ^ static_cast<std::uint64_t>(number));
  return hash;
}

std::size_t PoseCellHash::operator()(const PoseCell& cell) const {
  return hash_of(std::array{cell.turn, cell.row, cell.column});
}

int parts_of_a_turn(double width_rad) {
  // Not one part more for the rounding of a width that divides the turn.
  return std::max(1, static_cast<int>(std::ceil(2.0 * std::numbers::pi / width_rad - 1e-9)));
}

int square_parts_of_a_turn(double width_rad) {
  return 4 * parts_of_a_turn(4.0 * width_rad);
}

int wide_parts_of_a_turn(double width_rad) {
  return std::max(1, static_cast<int>(2.0 * std::numbers::pi / width_rad));
}

PoseCell PoseBinning::cell_of(const Pose2& pose) const {
  const double width = 2.0 * std::numbers::pi / turns;
  const auto turn = static_cast<std::int64_t>(std::floor(pose.theta / width + 0.5));
  return {(turn + turns) % turns, static_cast<std::int64_t>(std::floor(pose.y / side)),
          static_cast<std::int64_t>(std::floor(pose.x / side))};
}

PoseCells::PoseCells(std::span<const Pose2> poses, const PoseBinning& binning)
    : binning_(binning), order_(poses.size()) {
  std::vector<PoseCell> cells(poses.size());
  std::transform(poses.begin(), poses.end(), cells.begin(), [this](const Pose2& p) { return cell_of(p); });
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  std::ranges::stable_sort(order_, [&](std::size_t a, std::size_t b) { return cells[a] < cells[b]; });
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const PoseCell& cell = cells[order_[i]];
    if (!cells_.empty() && cells_.back() == cell) continue;
    cells_.push_back(cell);
    starts_.push_back(i);
  }
  starts_.push_back(order_.size());
}

}  // namespace glocal
