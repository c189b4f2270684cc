#include "matchers/grid_search.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>
#include <tuple>

#include "glocal/parallel.hpp"
#include "matchers/pose_grid.hpp"

namespace glocal {
namespace {

/// Rotations searched before the bar is raised. Fixed, so that the answer does not depend on the threads.
constexpr std::size_t rotations_at_a_time = 32;

struct GridPose {
  std::size_t in_contact = 0;
  std::size_t rotation = 0;
  int row = 0;
  int column = 0;
};

/// More contact; then the first in the grid, so that the order of the search does not matter.
bool is_better(const GridPose& a, const GridPose& b) {
  return std::tie(b.in_contact, a.rotation, a.row, a.column) <
         std::tie(a.in_contact, b.rotation, b.row, b.column);
}

/// A cell of robot poses.
using RobotCell = std::array<std::int32_t, 3>;
using BestOfCells = std::map<RobotCell, GridPose>;

void add(BestOfCells& best, const RobotCell& cell, const GridPose& pose) {
  const auto [place, is_new] = best.try_emplace(cell, pose);
  if (!is_new && is_better(pose, place->second)) place->second = pose;
}

/// How many points must be in contact for a share of them; at least one.
std::size_t least_in_contact(double share, std::size_t points) {
  const auto n = static_cast<double>(points);
  auto least = static_cast<std::size_t>(std::max(1.0, std::floor(share * n)));
  while (static_cast<double>(least) / n < share) ++least;
  return least;
}

/// What has been found in one rotation of the grid.
struct Found {
  BestOfCells best;
  std::size_t bound = 0;  ///< No pose of the rotation has more points in contact (after a first look).
  std::size_t tested = 0;
  std::size_t checks = 0;

  [[nodiscard]] std::size_t most_in_contact() const {
    std::size_t most = 0;
    for (const auto& [cell, pose] : best) most = std::max(most, pose.in_contact);
    return most;
  }
};

/// The translations of one rotation.
class RotationSearch {
 public:
  RotationSearch(const ContactPyramid& pyramid, const PoseGrid& grid, std::size_t rotation,
                 const Pose2& local_from_robot, const GridSearchRule& rule)
      : pyramid_(pyramid),
        rotation_(rotation),
        points_(grid.cells(rotation)),
        robot_at_zero_(grid.pose(rotation, 0, 0, pyramid.min_x(), pyramid.min_y()) * local_from_robot),
        side_(rule.distance / std::numbers::sqrt2),
        turn_(rule.rotation) {}

  /// A bound for all poses, and the best pose of the node that promises most.
  [[nodiscard]] Found look() {
    const int top = pyramid_.top_level();
    int column = 0;
    int row = 0;
    for_each_top_tile([&](int x, int y) {
      count(top, x, y, found_.bound + 1);
      if (counts_.largest() <= found_.bound) return;
      found_.bound = counts_.largest();
      const auto [i, k] = first_of(counts_.at_least(found_.bound));
      column = x + (i << top);
      row = y + (k << top);
    });
    for (int y = row; y < row + (1 << top); y += TileCounts::rows) {
      count(0, column, y, 1);
      add_poses(column, y, std::max<std::size_t>(1, counts_.largest()));
    }
    return std::move(found_);
  }

  /// All poses that bring at least so many points into contact.
  [[nodiscard]] Found search(std::size_t least) {
    for_each_top_tile([&](int x, int y) { descend(pyramid_.top_level(), x, y, least); });
    return std::move(found_);
  }

 private:
  /// Together they hold all translations that bring a point among the map's cells.
  template <class Visit>
  void for_each_top_tile(Visit visit) const {
    const auto columns = points_.columns();
    const auto rows = points_.rows();
    const auto [left, right] = std::minmax_element(columns.begin(), columns.end());
    const auto [low, high] = std::minmax_element(rows.begin(), rows.end());
    const int top = pyramid_.top_level();
    for (int y = -*high; y < pyramid_.rows() - *low; y += TileCounts::rows << top) {
      for (int x = -*right; x < pyramid_.columns() - *left; x += TileCounts::columns << top) visit(x, y);
    }
  }

  void count(int level, int column, int row, std::size_t least) {
    found_.checks += pyramid_.count(level, points_, column, row, least, counts_);
    if (level == 0) found_.tested += std::size_t{TileCounts::columns} * TileCounts::rows;
  }

  void descend(int level, int column, int row, std::size_t least) {
    count(level, column, row, least);
    if (level == 0) return add_poses(column, row, least);
    const TileCounts::Mask promising = counts_.at_least(least);
    // A quarter of the nodes makes a tile of the level below.
    constexpr int half_columns = TileCounts::columns / 2;
    constexpr int half_rows = TileCounts::rows / 2;
    for (int k = 0; k < TileCounts::rows; k += half_rows) {
      for (int i = 0; i < TileCounts::columns; i += half_columns) {
        std::uint64_t any = 0;
        for (int r = k; r < k + half_rows; ++r) any |= promising[static_cast<std::size_t>(r)] >> i;
        if (static_cast<std::uint32_t>(any) == 0) continue;
        descend(level - 1, column + (i << level), row + (k << level), least);
      }
    }
  }

  /// Those of the tile just counted, of level 0.
  void add_poses(int column, int row, std::size_t least) {
    const TileCounts::Mask nodes = counts_.at_least(least);
    for (int k = 0; k < TileCounts::rows; ++k) {
      for (std::uint64_t left = nodes[static_cast<std::size_t>(k)]; left != 0; left &= left - 1) {
        const int i = std::countr_zero(left);
        const GridPose pose{counts_.at(i, k), rotation_, row + k, column + i};
        add(found_.best, cell_of(pose), pose);
      }
    }
  }

  [[nodiscard]] RobotCell cell_of(const GridPose& pose) const {
    const auto cell = [](double value, double size) {
      return static_cast<std::int32_t>(std::floor(value / size));
    };
    return {cell(robot_at_zero_.theta, turn_), cell(robot_at_zero_.y + pyramid_.cell() * pose.row, side_),
            cell(robot_at_zero_.x + pyramid_.cell() * pose.column, side_)};
  }

  static std::array<int, 2> first_of(const TileCounts::Mask& nodes) {
    int row = 0;
    while (nodes[static_cast<std::size_t>(row)] == 0) ++row;
    return {std::countr_zero(nodes[static_cast<std::size_t>(row)]), row};
  }

  const ContactPyramid& pyramid_;
  std::size_t rotation_;
  CellPoints points_;
  Pose2 robot_at_zero_;  ///< The robot in the map, before any translation.
  double side_, turn_;   ///< Of a cell of robot poses.
  TileCounts counts_;
  Found found_;
};

/// The best poses so far, and what a pose must reach to become one of them.
class BestPoses {
 public:
  BestPoses(std::size_t most, std::size_t least) : most_(most), least_(least) {}

  void add(const Found& found) {
    for (const auto& [cell, pose] : found.best) {
      if (pose.in_contact >= least_) glocal::add(best_, cell, pose);
    }
  }

  /// If there are as many as are wanted, only what beats the last of them will do from now on.
  void raise() {
    if (best_.size() < most_) return;
    std::vector<std::size_t> contacts;
    for (const auto& [cell, pose] : best_) contacts.push_back(pose.in_contact);
    const auto last = contacts.begin() + static_cast<std::ptrdiff_t>(most_) - 1;
    std::nth_element(contacts.begin(), last, contacts.end(), std::greater<>());
    least_ = *last + 1;
    std::erase_if(best_, [&](const auto& entry) { return entry.second.in_contact < *last; });
  }

  [[nodiscard]] std::size_t least() const { return least_; }

  [[nodiscard]] std::vector<GridPose> poses() const {
    std::vector<GridPose> poses;
    for (const auto& [cell, pose] : best_) poses.push_back(pose);
    std::sort(poses.begin(), poses.end(), is_better);
    if (poses.size() > most_) poses.resize(most_);
    return poses;
  }

 private:
  std::size_t most_;
  std::size_t least_;  ///< Points in contact.
  BestOfCells best_;
};

}  // namespace

GridSearchResult search_grid(const ContactPyramid& pyramid, const Points& points,
                             const Pose2& local_from_robot, const GridSearchRule& rule, int threads) {
  const PoseGrid grid(points, pyramid.cell(), rule.min_rotation_step);
  const auto rotation = [&](std::size_t index) {
    return RotationSearch(pyramid, grid, index, local_from_robot, rule);
  };
  BestPoses best(rule.max_poses, least_in_contact(rule.min_quality, points.size()));
  GridSearchResult result;
  const auto take_in = [&](const std::vector<Found>& all) {
    for (const Found& found : all) {
      best.add(found);
      result.tested += found.tested;
      result.checks += found.checks;
    }
    best.raise();
  };

  std::vector<Found> looks(grid.rotations());
  parallel_for(threads, looks.size(), [&](std::size_t i) { looks[i] = rotation(i).look(); });
  take_in(looks);
  std::vector<std::size_t> order(looks.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return looks[a].most_in_contact() > looks[b].most_in_contact();
  });

  for (std::size_t begin = 0; begin < order.size(); begin += rotations_at_a_time) {
    std::vector<Found> found(std::min(rotations_at_a_time, order.size() - begin));
    parallel_for(threads, found.size(), [&](std::size_t i) {
      const std::size_t index = order[begin + i];
      if (looks[index].bound >= best.least()) found[i] = rotation(index).search(best.least());
    });
    take_in(found);
  }
  for (const GridPose& pose : best.poses()) {
    result.poses.push_back(
        {grid.pose(pose.rotation, pose.column, pose.row, pyramid.min_x(), pyramid.min_y()), pose.in_contact});
  }
  return result;
}

}  // namespace glocal
