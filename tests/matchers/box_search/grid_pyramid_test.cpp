#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "glocal/error.hpp"
#include "glocal/rng.hpp"
#include "matchers/box_search/box_pyramid.hpp"
#include "points.hpp"

namespace glocal::grid_pyramid_test {
namespace {

constexpr double cell = 0.1;
constexpr double epsilon = 0.15;

Points random_map(Rng& rng, std::size_t n) {
  Points map;
  for (std::size_t i = 0; i < n; ++i) {
    map.push_back(
        {static_cast<float>(rng.uniform(-3.0, 9.0)), static_cast<float>(rng.uniform(2.0, 8.0)), 0.0F});
  }
  return map;
}

CellPoints random_points(Rng& rng, std::size_t n) {
  CellPoints points;
  for (std::size_t i = 0; i < n; ++i) {
    points.push_back(static_cast<int>(rng.below(81)) - 40, static_cast<int>(rng.below(81)) - 40);
  }
  return points;
}

CellPoints at(int column, int row) {
  CellPoints point;
  point.push_back(column, row);
  return point;
}

/// Which cells are in contact, by the distances from their centres to all points.
class ContactCells {
 public:
  ContactCells(const Points& map, const BoxPyramid& pyramid) {
    for (int row = 0; row < pyramid.frame().rows; ++row) {
      for (int column = 0; column < pyramid.frame().columns; ++column) {
        const double x = pyramid.frame().min_x + (column + 0.5) * pyramid.frame().cell;
        const double y = pyramid.frame().min_y + (row + 0.5) * pyramid.frame().cell;
        for (std::size_t i = 0; i < map.size(); ++i) {
          if (std::hypot(map.x[i] - x, map.y[i] - y) > epsilon) continue;
          cells_.insert({column, row});
          break;
        }
      }
    }
  }

  [[nodiscard]] bool any_from(int column, int row, int size) const {
    for (int r = row; r < row + size; ++r) {
      for (int c = column; c < column + size; ++c) {
        if (cells_.contains({c, r})) return true;
      }
    }
    return false;
  }

  /// Points in contact after a translation.
  [[nodiscard]] std::size_t count(const CellPoints& points, int column, int row) const {
    return windows(points, column, row, 1);
  }

  /// Points that meet a cell in contact after any of size x size translations, not all after the same.
  [[nodiscard]] std::size_t windows(const CellPoints& points, int column, int row, int size) const {
    std::size_t n = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (any_from(points.columns()[i] + column, points.rows()[i] + row, size)) ++n;
    }
    return n;
  }

 private:
  std::set<std::pair<int, int>> cells_;
};

TEST(PyramidOfGrid, BoundsEveryPoseOfANodeAndCountsExactlyAtTheBottom) {
  Rng rng(1);
  const Points map = random_map(rng, 60);
  const BoxPyramid pyramid(BoxPyramid::Of::pose_grid, map, cell, epsilon, 3);
  const ContactCells cells(map, pyramid);
  TileCounts counts;
  int bounds_above_any_pose = 0;
  for (int i = 0; i < 200; ++i) {
    const CellPoints points = random_points(rng, 1 + rng.below(90));
    const int level = static_cast<int>(rng.below(4));
    const int size = 1 << level;
    // Tiles that reach over each side of the map, and such that lie beside it.
    const int column = static_cast<int>(rng.below(260)) - 130 - 32 * size;
    const int row = static_cast<int>(rng.below(160)) - 80 - 4 * size;
    pyramid.count(level, {points}, column, row, 0, 0, counts);
    for (int k = 0; k < 5; ++k) {
      const int node_column = static_cast<int>(rng.below(TileCounts::columns));
      const int node_row = static_cast<int>(rng.below(TileCounts::rows));
      const int first_column = column + node_column * size;
      const int first_row = row + node_row * size;
      const std::size_t bound = counts.at(node_column, node_row);
      std::size_t best = 0;
      for (int r = 0; r < size; ++r) {
        for (int c = 0; c < size; ++c)
          best = std::max(best, cells.count(points, first_column + c, first_row + r));
      }
      ASSERT_GE(bound, best);
      ASSERT_EQ(bound, cells.windows(points, first_column, first_row, size));
      if (level == 0) {
        ASSERT_EQ(bound, best);
      }
      if (bound > best) ++bounds_above_any_pose;
    }
  }
  EXPECT_GT(bounds_above_any_pose, 0);  // or there was nothing to tell a bound from a count
}

TEST(PyramidOfGrid, WindowsBeginAnywhere) {
  // One point in the middle of a cell: with epsilon of less than a cell, that cell alone is in contact.
  const Points map = test::points_of({{1.0F, 1.0F, 0.0F}});
  const BoxPyramid pyramid(BoxPyramid::Of::pose_grid, map, 0.1, 0.06, 2);
  TileCounts counts;
  std::pair<int, int> in_contact{-1, -1};
  std::size_t cells = 0;
  for (int row = 0; row < pyramid.frame().rows; ++row) {
    for (int column = 0; column < pyramid.frame().columns; ++column) {
      pyramid.count(0, {at(column, row)}, 0, 0, 0, 0, counts);
      cells += counts.at(0, 0);
      if (counts.at(0, 0) == 1) in_contact = {column, row};
    }
  }
  ASSERT_EQ(cells, 1U);
  // A maximum over aligned blocks of 2 x 2 or 4 x 4 cells would not see it from most of these.
  for (const int level : {1, 2}) {
    const int size = 1 << level;
    for (int before_column = -1; before_column <= size; ++before_column) {
      for (int before_row = -1; before_row <= size; ++before_row) {
        const bool reached =
            before_column >= 0 && before_column < size && before_row >= 0 && before_row < size;
        const CellPoints point = at(in_contact.first - before_column, in_contact.second - before_row);
        pyramid.count(level, {point}, 0, 0, 0, 0, counts);
        EXPECT_EQ(counts.at(0, 0), reached ? 1U : 0U) << level << " " << before_column << " " << before_row;
      }
    }
  }
}

TEST(PyramidOfGrid, LargestAndAtLeastSayWhatTheCountsSay) {
  Rng rng(2);
  const Points map = random_map(rng, 300);
  const BoxPyramid pyramid(BoxPyramid::Of::pose_grid, map, cell, epsilon, 1);
  const CellPoints points = random_points(rng, 700);
  TileCounts counts;
  pyramid.count(1, {points}, 0, 0, 0, 0, counts);
  std::size_t largest = 0;
  for (int row = 0; row < TileCounts::rows; ++row) {
    for (int column = 0; column < TileCounts::columns; ++column)
      largest = std::max(largest, counts.at(column, row));
  }
  ASSERT_GT(largest, 128U);
  EXPECT_EQ(counts.largest(), largest);
  for (const std::size_t least :
       {std::size_t{0}, std::size_t{1}, largest / 2, largest, largest + 1, std::size_t{5000}}) {
    const TileCounts::Mask mask = counts.at_least(least);
    for (int row = 0; row < TileCounts::rows; ++row) {
      for (int column = 0; column < TileCounts::columns; ++column) {
        EXPECT_EQ((mask[static_cast<std::size_t>(row)] >> column & 1U) != 0, counts.at(column, row) >= least);
      }
    }
  }
}

TEST(PyramidOfGrid, StopsOnlyWhereNoNodeCanReachWhatIsAskedFor) {
  Rng rng(3);
  const Points map = random_map(rng, 100);
  const BoxPyramid pyramid(BoxPyramid::Of::pose_grid, map, cell, epsilon, 0);
  const CellPoints points = random_points(rng, 500);
  TileCounts all;
  TileCounts stopped;
  ASSERT_GT(pyramid.count(0, {points}, 0, 0, 0, 0, all), 64U);
  const std::size_t largest = all.largest();
  EXPECT_LT(pyramid.count(0, {points}, 0, 0, 0, points.size(), stopped), points.size());
  EXPECT_LT(stopped.largest(), points.size());
  pyramid.count(0, {points}, 0, 0, 0, largest, stopped);
  EXPECT_EQ(stopped.at_least(largest), all.at_least(largest));
  pyramid.count(0, {points}, 0, 0, 0, largest + 1, stopped);
  EXPECT_EQ(stopped.at_least(largest + 1), TileCounts::Mask{});
}

TEST(PyramidOfGrid, RefusesAMapThatIsTooLarge) {
  const Points map = test::points_of({{0.0F, 0.0F, 0.0F}, {1e6F, 1e6F, 0.0F}});
  EXPECT_THROW(BoxPyramid(BoxPyramid::Of::pose_grid, map, 0.05, 0.1, 4), ConfigError);
}

}  // namespace
}  // namespace glocal::grid_pyramid_test
