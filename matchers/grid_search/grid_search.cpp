#include "matchers/grid_search/grid_search.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "glocal/parallel.hpp"
#include "matchers/grid_search/pose_grid.hpp"

namespace glocal {
namespace {

/// Rotations searched before the bar is raised. Fixed, so that the answer does not depend on the threads.
constexpr std::size_t rotations_at_a_time = 32;

/// A first look at one rotation of the grid.
struct Look {
  FoundPoses found;
  std::size_t bound = 0;  ///< No pose of the rotation has more points in contact.
};

std::size_t most_in_contact(const FoundPoses& found) {
  std::size_t most = 0;
  for (const auto& [cell, pose] : found.best) most = std::max(most, pose.in_contact);
  return most;
}

/// Translations by whole layers, from the first to the last.
struct Layers {
  int first = 0, last = 0;
};

/// All that leave a robot, which is at a height (m) in the local frame, within the frame.
Layers layers_of_robot(const ContactPyramid& pyramid, double robot_height) {
  if (!pyramid.frame().in_space) return {};
  const double height = robot_height / pyramid.frame().cell;
  return {static_cast<int>(std::ceil(-height)),
          static_cast<int>(std::ceil(pyramid.frame().layers - height)) - 1};
}

/// The translations of one rotation.
class RotationSearch {
 public:
  RotationSearch(const ContactPyramid& pyramid, const PoseGrid& grid, std::size_t rotation,
                 const Pose2& local_from_robot, double robot_height, const GridSearchRule& rule)
      : pyramid_(pyramid),
        rotation_(rotation),
        points_(grid.cells(rotation)),
        layers_(layers_of_robot(pyramid, robot_height)),
        allowed_(rule.gate, grid.pose(rotation, 0, 0, pyramid.frame().min_x, pyramid.frame().min_y),
                 pyramid.frame().cell),
        robots_(grid.pose(rotation, 0, 0, pyramid.frame().min_x, pyramid.frame().min_y) * local_from_robot,
                pyramid.frame().min_z + robot_height, pyramid.frame().cell, rule) {}

  /// A bound for all poses, and the best pose of the node that promises most.
  [[nodiscard]] Look look() {
    const int top = pyramid_.top_level();
    std::size_t bound = 0;
    int column = 0;
    int row = 0;
    int layer = layers_.first;
    for_each_top_tile([&](int x, int y, int z) {
      count(top, x, y, z, bound + 1);
      if (counts_.largest() <= bound) return;
      bound = counts_.largest();
      const auto [i, k] = first_of(counts_.at_least(bound));
      column = x + (i << top);
      row = y + (k << top);
      layer = z;
    });
    for (int z = layer; z < layer + (1 << top) && z <= layers_.last; ++z) {
      for (int y = row; y < row + (1 << top); y += TileCounts::rows) {
        count(0, column, y, z, 1);
        add_poses(column, y, z, std::max<std::size_t>(1, counts_.largest()));
      }
    }
    return {std::move(found_), bound};
  }

  /// All poses that bring at least so many points into contact.
  [[nodiscard]] FoundPoses search(std::size_t least) {
    for_each_top_tile([&](int x, int y, int z) { descend(pyramid_.top_level(), x, y, z, least); });
    return std::move(found_);
  }

 private:
  /// Together they hold all translations that bring a point among the map's cells.
  template <class Visit>
  void for_each_top_tile(Visit visit) const {
    const Translations all = translations(points_, pyramid_.frame());
    const int top = pyramid_.top_level();
    for (int z = layers_.first; z <= layers_.last; z += 1 << top) {
      for (int y = all.first_row; y <= all.last_row; y += TileCounts::rows << top) {
        for (int x = all.first_column; x <= all.last_column; x += TileCounts::columns << top) {
          if (allowed_.any(x, y, TileCounts::columns << top, TileCounts::rows << top)) visit(x, y, z);
        }
      }
    }
  }

  void count(int level, int column, int row, int layer, std::size_t least) {
    found_.points_tested += pyramid_.count(level, points_, column, row, least, counts_, layer);
    if (level == 0) found_.tested += std::size_t{TileCounts::columns} * TileCounts::rows;
  }

  void descend(int level, int column, int row, int layer, std::size_t least) {
    count(level, column, row, layer, least);
    if (level == 0) return add_poses(column, row, layer, least);
    const TileCounts::Mask promising = counts_.at_least(least);
    // A quarter of the nodes makes a tile of the level below; in space, one for each half of the layers.
    const int half_layers = 1 << (level - 1);
    constexpr int half_columns = TileCounts::columns / 2;
    constexpr int half_rows = TileCounts::rows / 2;
    for (int k = 0; k < TileCounts::rows; k += half_rows) {
      for (int i = 0; i < TileCounts::columns; i += half_columns) {
        std::uint64_t any = 0;
        for (int r = k; r < k + half_rows; ++r) any |= promising[static_cast<std::size_t>(r)] >> i;
        if (static_cast<std::uint32_t>(any) == 0) continue;
        if (!allowed_.any(column + (i << level), row + (k << level), half_columns << level,
                          half_rows << level))
          continue;
        for (int z = layer; z < layer + 2 * half_layers && z <= layers_.last; z += half_layers)
          descend(level - 1, column + (i << level), row + (k << level), z, least);
      }
    }
  }

  /// Those of the tile just counted, of level 0.
  void add_poses(int column, int row, int layer, std::size_t least) {
    const TileCounts::Mask nodes = counts_.at_least(least);
    for (int k = 0; k < TileCounts::rows; ++k) {
      for (std::uint64_t left = nodes[static_cast<std::size_t>(k)]; left != 0; left &= left - 1) {
        const int i = std::countr_zero(left);
        if (!allowed_.any(column + i, row + k)) continue;
        const GridPose pose{counts_.at(i, k), rotation_, row + k, column + i, layer};
        add(found_.best, robots_.of(pose), pose);
      }
    }
  }

  static std::array<int, 2> first_of(const TileCounts::Mask& nodes) {
    int row = 0;
    while (nodes[static_cast<std::size_t>(row)] == 0) ++row;
    return {std::countr_zero(nodes[static_cast<std::size_t>(row)]), row};
  }

  const ContactPyramid& pyramid_;
  std::size_t rotation_;
  CellPoints points_;
  Layers layers_;
  AllowedTranslations allowed_;
  RobotCells robots_;
  TileCounts counts_;
  FoundPoses found_;
};

}  // namespace

GridSearchResult search_grid(const ContactPyramid& pyramid, const Points& points,
                             const Pose2& local_from_robot, const GridSearchRule& rule, int threads,
                             double robot_height) {
  const CellFrame& frame = pyramid.frame();
  const PoseGrid grid(points, frame.cell, rule.min_rotation_step);
  const auto rotation = [&](std::size_t index) {
    return RotationSearch(pyramid, grid, index, local_from_robot, robot_height, rule);
  };
  std::vector<std::size_t> bounds(grid.rotations());
  std::vector<FoundPoses> found(grid.rotations());
  parallel_for(threads, found.size(), [&](std::size_t i) {
    Look look = rotation(i).look();
    bounds[i] = look.bound;
    found[i] = std::move(look.found);
  });
  BestPoses best(rule, points.size());
  best.add(found);
  std::vector<std::size_t> order(found.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return most_in_contact(found[a]) > most_in_contact(found[b]);
  });

  for (std::size_t begin = 0; begin < order.size(); begin += rotations_at_a_time) {
    found.assign(std::min(rotations_at_a_time, order.size() - begin), {});
    parallel_for(threads, found.size(), [&](std::size_t i) {
      const std::size_t index = order[begin + i];
      if (bounds[index] >= best.least()) found[i] = rotation(index).search(best.least());
    });
    best.add(found);
  }
  return best.result(grid, frame);
}

}  // namespace glocal
