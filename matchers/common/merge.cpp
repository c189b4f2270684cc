#include "matchers/common/merge.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <unordered_map>

#include "glocal/pose_cells.hpp"

namespace glocal {
namespace {

/// The best of the hypotheses in each cell, whose hash table is `Places`.
template <class Places, class CellOf>
std::vector<Hypothesis> best_of_cells(const std::vector<Hypothesis>& hypotheses, CellOf cell_of) {
  std::vector<Hypothesis> best;
  Places place_of_cell;
  place_of_cell.reserve(hypotheses.size());
  for (const Hypothesis& hypothesis : hypotheses) {
    const auto [it, is_new] = place_of_cell.try_emplace(cell_of(hypothesis), best.size());
    if (is_new) {
      best.push_back(hypothesis);
    } else {
      best[it->second].support += hypothesis.support;
    }
  }
  return best;
}

constexpr double first_side = 0.05;          // m
constexpr double first_turn = radians(2.0);  // rad

std::vector<Hypothesis> merged_in_plane(const std::vector<Hypothesis>& hypotheses,
                                        const Pose2& local_from_robot, double scale) {
  const PoseBinning binning{scale * first_side, parts_of_a_turn(scale * first_turn)};
  // Parts of the turn begin at multiples of their width, not half a width before: which hypotheses of the
  // paper's experiments are merged has always depended on that.
  const double half_a_part = std::numbers::pi / binning.turns;
  using Places = std::unordered_map<PoseCell, std::size_t, PoseCellHash>;
  return best_of_cells<Places>(hypotheses, [&](const Hypothesis& hypothesis) {
    Pose2 robot = seen_from_above(hypothesis.map_from_local) * local_from_robot;
    robot.theta -= half_a_part;
    return binning.cell_of(robot);
  });
}

using SpatialCell = std::array<std::int64_t, 6>;

struct SpatialCellHash {
  std::size_t operator()(const SpatialCell& cell) const { return hash_of(cell); }
};

std::vector<Hypothesis> merged_in_space(const std::vector<Hypothesis>& hypotheses,
                                        const Pose3& local_from_robot, double scale) {
  using Places = std::unordered_map<SpatialCell, std::size_t, SpatialCellHash>;
  return best_of_cells<Places>(hypotheses, [&](const Hypothesis& hypothesis) {
    const Pose3 robot = hypothesis.map_from_local * local_from_robot;
    const Vector3 turn = logarithm(robot.rotation);
    // Rounded to the nearest, so that everything is in one cell in the end.
    const auto part = [scale](double value, double width) {
      return static_cast<std::int64_t>(std::floor(value / (scale * width) + 0.5));
    };
    return SpatialCell{part(robot.x, first_side),  part(robot.y, first_side),  part(robot.z, first_side),
                       part(turn.x(), first_turn), part(turn.y(), first_turn), part(turn.z(), first_turn)};
  });
}

}  // namespace

void merge_hypotheses(std::vector<Hypothesis>& hypotheses, const Pose3& local_from_robot, std::size_t most) {
  const bool is_planar = local_from_robot.is_planar() &&
                         std::ranges::all_of(hypotheses, &Pose3::is_planar, &Hypothesis::map_from_local);
  for (double scale = 1.0; hypotheses.size() > most; scale *= 2.0) {
    hypotheses = is_planar ? merged_in_plane(hypotheses, seen_from_above(local_from_robot), scale)
                           : merged_in_space(hypotheses, local_from_robot, scale);
  }
}

void append(const MatchResult& part, MatchResult& whole) {
  whole.hypotheses.insert(whole.hypotheses.end(), part.hypotheses.begin(), part.hypotheses.end());
  whole.proposals += part.proposals;
  whole.points_tested += part.points_tested;
}

MatchResult joined(const std::vector<MatchResult>& chunks, const Pose3& local_from_robot, std::size_t most) {
  MatchResult result;
  for (const MatchResult& chunk : chunks) append(chunk, result);
  std::ranges::stable_sort(result.hypotheses, std::greater<>(), &Hypothesis::score);
  merge_hypotheses(result.hypotheses, local_from_robot, most);
  return result;
}

}  // namespace glocal
