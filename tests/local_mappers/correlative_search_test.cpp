#include "local_mappers/correlative_search.hpp"

#include <gtest/gtest.h>

#include "local_mappers/rooms.hpp"
#include "points.hpp"

namespace glocal::local_mappers::correlative_search_test {
namespace {

constexpr double resolution = 0.05;
constexpr double sigma = 0.1;

PointGrid grid_of(const Points& points) {
  PointGrid grid(resolution, 9, sigma, 1000);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const GridCell cell = grid.cell(points.x[i], points.y[i]);
    if (grid.inside(cell) == PointGrid::none) {
      EXPECT_TRUE(grid.insert(cell, i));
    }
  }
  return grid;
}

/// Mean likelihood of all hits at a pose, cell by cell.
double likelihood_at(const PointGrid& grid, const Points& hits, const Pose2& pose) {
  const Transform transform(pose);
  double sum = 0.0;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const Point p = transform(hits[i]);
    std::array<std::uint8_t, PointGrid::window_width> row{};
    grid.likelihood_rows(grid.cell(p.x, p.y), 1, row.data());
    sum += row[0] / 255.0;
  }
  return sum / static_cast<double>(hits.size());
}

class CorrelativeSearch : public ::testing::Test {
 protected:
  Rng rng{1};
  Points hits = test::scan_from(test::furnished_room(), {2, 2, 0.3}, {.beams = 91}, rng).hits;
  PointGrid grid = grid_of(hits);
  CorrelativeSearchParams params;
};

TEST_F(CorrelativeSearch, FindsAScanInItself) {
  const Pose2 wrong{0.1, -0.05, radians(6)};
  const SearchResult found = correlative_search(grid, hits, wrong, params, 0.0);
  EXPECT_NEAR(found.local_from_robot.x, 0.0, 1e-6);
  EXPECT_NEAR(found.local_from_robot.y, 0.0, 1e-6);
  EXPECT_NEAR(found.local_from_robot.theta, 0.0, 1e-6);
  EXPECT_DOUBLE_EQ(found.likelihood, 1.0);
}

TEST_F(CorrelativeSearch, NoPoseOfTheBoxIsBetterByBruteForce) {
  const Pose2 predicted{0.07, -0.08, 0.06};
  const SearchResult found = correlative_search(grid, hits, predicted, params, 0.0);
  // Rounding may put a hit at the border of a cell on its other side.
  EXPECT_NEAR(found.likelihood, likelihood_at(grid, hits, found.local_from_robot), 5e-3);
  for (int turn = -9; turn <= 9; ++turn) {
    for (int dx = -2; dx <= 2; ++dx) {
      for (int dy = -2; dy <= 2; ++dy) {
        const Pose2 pose{predicted.x + 0.05 * dx, predicted.y + 0.05 * dy, predicted.theta + radians(turn)};
        EXPECT_GE(found.likelihood, likelihood_at(grid, hits, pose) - 5e-3) << turn << ' ' << dx << ' ' << dy;
      }
    }
  }
}

TEST_F(CorrelativeSearch, ThePenaltyHoldsOdometryWhereHitsSayNothing) {
  const Points far = test::points_of({{500, 500, 0}});
  const Pose2 predicted{0.02, 0.03, 0.04};
  const SearchResult found = correlative_search(grid, far, predicted, params, 0.01);
  EXPECT_EQ(found.local_from_robot, predicted);
  EXPECT_EQ(found.likelihood, 0.0);
  EXPECT_EQ(correlative_search(grid, {}, predicted, params, 0.01).local_from_robot, predicted);
}

TEST_F(CorrelativeSearch, WithoutTranslationItOnlyTurns) {
  params.translation = 0.0;
  const SearchResult found = correlative_search(grid, hits, {0.0, 0.0, radians(9)}, params, 0.0);
  EXPECT_EQ(found.local_from_robot.x, 0.0);
  EXPECT_EQ(found.local_from_robot.y, 0.0);
  EXPECT_NEAR(found.local_from_robot.theta, 0.0, 1e-6);
  const Pose2 beyond{0.0, 0.0, radians(12)};
  EXPECT_GE(correlative_search(grid, hits, beyond, params, 0.0).local_from_robot.theta, radians(3) - 1e-6);
}

}  // namespace
}  // namespace glocal::local_mappers::correlative_search_test
