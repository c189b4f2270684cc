#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>
#include <map>
#include <numbers>
#include <tuple>
#include <vector>

#include "glocal/rng.hpp"
#include "matchers/box_search/search_boxes.hpp"
#include "test_world.hpp"

namespace glocal::grid_search_test {
namespace {

constexpr double cell = 0.2;
constexpr double epsilon = 0.2;

struct Problem {
  Points map;
  Points local;
  Pose2 local_from_robot;
};

struct GridPose {
  Pose2 map_from_local;
  std::size_t in_contact = 0;
};

/// All poses of the grid with a point in contact, counted one point at a time.
std::vector<GridPose> brute_force(const Problem& problem, const BoxPyramid& pyramid, std::size_t least) {
  const auto index = [&](int column, int row) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(pyramid.frame().columns) +
           static_cast<std::size_t>(column);
  };
  std::vector<std::uint8_t> contact(index(0, pyramid.frame().rows), 0);
  for (int row = 0; row < pyramid.frame().rows; ++row) {
    for (int column = 0; column < pyramid.frame().columns; ++column) {
      const double x = pyramid.frame().min_x + (column + 0.5) * cell;
      const double y = pyramid.frame().min_y + (row + 0.5) * cell;
      for (std::size_t i = 0; i < problem.map.size(); ++i) {
        if (std::hypot(problem.map.x[i] - x, problem.map.y[i] - y) <= epsilon) {
          contact[index(column, row)] = 1;
        }
      }
    }
  }
  std::vector<GridPose> poses;
  const PoseGrid grid(problem.local, pyramid.frame(), 0.001);
  for (std::size_t rotation = 0; rotation < grid.rotations(0); ++rotation) {
    const CellPoints points = grid.cells(0, rotation).front();
    for (int row = -60; row < pyramid.frame().rows + 60; ++row) {
      for (int column = -60; column < pyramid.frame().columns + 60; ++column) {
        std::size_t in_contact = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
          const int c = points.columns()[i] + column;
          const int r = points.rows()[i] + row;
          if (c < 0 || r < 0 || c >= pyramid.frame().columns || r >= pyramid.frame().rows) continue;
          in_contact += contact[index(c, r)];
        }
        if (in_contact < std::max<std::size_t>(1, least)) continue;
        poses.push_back({grid.pose(0, rotation, column, row), in_contact});
      }
    }
  }
  return poses;
}

BoxSearchResult search(const BoxPyramid& pyramid, const Problem& p, const BoxSearchRule& rule,
                       int threads = 1) {
  return search_boxes(pyramid, p.local, p.local_from_robot, rule, std::nullopt, threads);
}

/// The contact of the best pose in each cell of robot poses, falling.
std::vector<std::size_t> best_of_cells(const std::vector<GridPose>& poses, const Pose2& local_from_robot,
                                       const BoxSearchRule& rule) {
  std::map<std::tuple<int, int, int>, std::size_t> best;
  // As many parts of a right angle as are at most so wide; headings are rounded to the nearest.
  const int quarter = static_cast<int>(std::ceil(std::numbers::pi / 2.0 / rule.cell_rotation));
  for (const GridPose& pose : poses) {
    const Pose2 robot = pose.map_from_local * local_from_robot;
    const auto number = [](double value, double size) { return static_cast<int>(std::floor(value / size)); };
    const double side = rule.cell_distance / std::numbers::sqrt2;
    const auto nearest = static_cast<int>(std::lround(robot.theta / (std::numbers::pi / 2.0) * quarter));
    const int turn = nearest == -2 * quarter ? 2 * quarter : nearest;  // both are 180 degrees
    std::size_t& most = best[{number(robot.x, side), number(robot.y, side), turn}];
    most = std::max(most, pose.in_contact);
  }
  std::vector<std::size_t> contacts;
  for (const auto& [place, most] : best) contacts.push_back(most);
  std::sort(contacts.begin(), contacts.end(), std::greater<>());
  return contacts;
}

std::vector<std::size_t> contacts_of(const BoxSearchResult& result) {
  std::vector<std::size_t> contacts;
  for (const auto& pose : result.poses) contacts.push_back(pose.in_contact);
  return contacts;
}

Problem small_world_problem(const Pose2& map_from_robot) {
  // Every fourth point of the world's walls will do for cells of 20 cm.
  const auto every_fourth = [](const Points& points) {
    Points few;
    for (std::size_t i = 0; i < points.size(); i += 4) few.push_back(points[i]);
    return few;
  };
  const Pose2 local_from_robot{0.7, -0.4, 1.0};
  const Points seen = test::seen_from(test::small_world_points(), map_from_robot, 2.5);
  return {every_fourth(test::small_world_points()), every_fourth(test::moved(seen, local_from_robot)),
          local_from_robot};
}

Problem random_problem(std::uint64_t seed) {
  Rng rng(seed);
  const auto random = [&](double low, double high) { return static_cast<float>(rng.uniform(low, high)); };
  Problem problem;
  for (int i = 0; i < 160; ++i) problem.map.push_back({random(-4.0, 3.0), random(1.0, 6.0), 0.0F});
  for (int i = 0; i < 12; ++i) problem.local.push_back({random(0.0, 3.0), random(-1.0, 1.0), 0.0F});
  problem.local_from_robot = Pose2{rng.uniform(-1.0, 1.0), rng.uniform(-1.0, 1.0), rng.uniform(-3.0, 3.0)};
  return problem;
}

class GridSearch : public ::testing::TestWithParam<int> {
 protected:
  static Problem problem() {
    const int i = GetParam();
    if (i == 0) return small_world_problem({2.0, 2.0, 0.3});
    if (i == 1) return small_world_problem({2.0, 7.0, -2.0});
    return random_problem(static_cast<std::uint64_t>(i));
  }
};

TEST_P(GridSearch, FindsWhatBruteForceFinds) {
  const Problem p = problem();
  const BoxPyramid pyramid(BoxPyramid::Of::pose_grid, p.map, cell, epsilon, 3);
  for (const double min_quality : {0.0, 0.5, 0.75}) {
    const auto least = static_cast<std::size_t>(std::ceil(min_quality * static_cast<double>(p.local.size())));
    const std::vector<GridPose> all = brute_force(p, pyramid, least);
    const BoxSearchRule rule{
        .least = std::max<std::size_t>(1, least), .most_places = 1000000, .min_rotation_step = 0.001};
    const BoxSearchResult found = search(pyramid, p, rule);
    EXPECT_EQ(contacts_of(found), best_of_cells(all, p.local_from_robot, rule));
    if (min_quality < 0.75) continue;  // many millions of pairs
    ASSERT_FALSE(all.empty());
    for (const auto& pose : found.poses) {
      EXPECT_TRUE(std::any_of(all.begin(), all.end(), [&](const GridPose& other) {
        return distance(other.map_from_local, pose.map_from_local) < 1e-9 &&
               rotation_between(other.map_from_local, pose.map_from_local) < 1e-9 &&
               other.in_contact == pose.in_contact;
      }));
    }
    for (const GridPose& pose : all) {
      const Pose2 robot = pose.map_from_local * p.local_from_robot;
      EXPECT_TRUE(std::any_of(found.poses.begin(), found.poses.end(), [&](const auto& other) {
        const Pose2 other_robot = other.map_from_local * p.local_from_robot;
        return other.in_contact >= pose.in_contact && distance(robot, other_robot) <= rule.cell_distance &&
               rotation_between(robot, other_robot) <= rule.cell_rotation;
      }));
    }
  }
}

TEST_P(GridSearch, WithALimitFindsTheBest) {
  const Problem p = problem();
  const BoxPyramid pyramid(BoxPyramid::Of::pose_grid, p.map, cell, epsilon, 3);
  BoxSearchRule rule{.min_rotation_step = 0.001};
  std::vector<std::size_t> best = best_of_cells(brute_force(p, pyramid, 1), p.local_from_robot, rule);
  for (const std::size_t limit : {std::size_t{100}, std::size_t{20}, std::size_t{1}}) {
    ASSERT_GT(best.size(), limit);
    best.resize(limit);
    rule.most_places = limit;
    EXPECT_EQ(contacts_of(search(pyramid, p, rule)), best);
  }
}

TEST_P(GridSearch, OfAllPosesItFindsTheBestThatAreAllowed) {
  const Problem p = problem();
  const BoxPyramid pyramid(BoxPyramid::Of::pose_grid, p.map, cell, epsilon, 3);
  const Pose2 local_from_start{-0.5, 0.3, 2.0};
  std::vector<GridPose> all = brute_force(p, pyramid, 1);
  for (const Prior& prior :
       {Prior{.region = {2.1, 2.3, 1.5}, .heading = {}}, Prior{.region = {}, .heading = {-100.0, 130.0}},
        Prior{.region = {0.1, 3.3, 3.0}, .heading = {30.0, 200.0}}}) {
    const PoseGate gate(prior, local_from_start);
    BoxSearchRule rule{.most_places = 1000000, .min_rotation_step = 0.001, .gate = gate};
    std::vector<GridPose> allowed;
    std::copy_if(all.begin(), all.end(), std::back_inserter(allowed), [&](const GridPose& pose) {
      const Pose2 start = pose.map_from_local * local_from_start;
      const double turn = degrees(start.theta) - prior.heading.deg.value_or(0.0);
      return std::hypot(start.x - prior.region.x.value_or(0.0), start.y - prior.region.y.value_or(0.0)) <=
                 prior.region.radius.value_or(1e9) &&
             std::abs(std::remainder(turn, 360.0)) <= prior.heading.width_deg.value_or(360.0) / 2.0;
    });
    std::vector<std::size_t> best = best_of_cells(allowed, p.local_from_robot, rule);
    ASSERT_GT(best.size(), 20U);
    EXPECT_EQ(contacts_of(search(pyramid, p, rule)), best);
    rule.most_places = 20;
    best.resize(20);
    EXPECT_EQ(contacts_of(search(pyramid, p, rule, 2)), best);
  }
}

TEST_P(GridSearch, AnswersAlikeForAnyNumberOfThreads) {
  const Problem p = problem();
  const BoxPyramid pyramid(BoxPyramid::Of::pose_grid, p.map, cell, epsilon, 2);
  const BoxSearchRule rule{.least = (3 * p.local.size() + 9) / 10};
  const BoxSearchResult one = search(pyramid, p, rule);
  const BoxSearchResult two = search(pyramid, p, rule, 2);
  ASSERT_EQ(contacts_of(one), contacts_of(two));
  for (std::size_t i = 0; i < one.poses.size(); ++i) {
    EXPECT_EQ(one.poses[i].map_from_local, two.poses[i].map_from_local);
  }
  EXPECT_EQ(one.looks, two.looks);
  EXPECT_EQ(one.tested, two.tested);
}

INSTANTIATE_TEST_SUITE_P(Worlds, GridSearch, ::testing::Range(0, 6));

TEST(GridSearch, FindsBothOfTwoEqualPlaces) {
  // The small world twice, a whole number of cells apart.
  Problem p = small_world_problem({2.0, 2.0, 0.3});
  const std::size_t n = p.map.size();
  for (std::size_t i = 0; i < n; ++i) p.map.push_back({p.map.x[i] + 12.0F, p.map.y[i], 0.0F});
  const BoxPyramid pyramid(BoxPyramid::Of::pose_grid, p.map, cell, epsilon, 3);
  const BoxSearchResult found = search(pyramid, p, {.least = (p.local.size() + 1) / 2});
  ASSERT_GE(found.poses.size(), 2U);
  const std::size_t most = found.poses.front().in_contact;
  std::vector<Pose2> best;
  for (const auto& pose : found.poses) {
    if (pose.in_contact == most) best.push_back(pose.map_from_local);
  }
  for (const Pose2& pose : best) {
    const double other_x = pose.x < 8.0 ? pose.x + 12.0 : pose.x - 12.0;
    EXPECT_TRUE(std::any_of(best.begin(), best.end(), [&](const Pose2& other) {
      return distance(other, {other_x, pose.y, pose.theta}) < 0.4 && rotation_between(other, pose) < 0.2;
    }));
  }
}

}  // namespace
}  // namespace glocal::grid_search_test
