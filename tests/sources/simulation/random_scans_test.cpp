#include "sources/simulation/random_scans.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "files.hpp"
#include "samples.hpp"
#include "sources/plan.hpp"

namespace glocal::simulation::random_scans_test {
namespace {

constexpr double pi = std::numbers::pi;

RandomScans::Params params_of(const test::Plan& plan) {
  RandomScans::Params params;
  params.map.path = plan.file();
  return params;
}

std::string fault_of(const RandomScans::Params& params, const test::Plan& plan) {
  return test::config_error(plan.folder(), [&] { RandomScans(params, {}); });
}

std::vector<Sample> read_all(const RandomScans::Params& params, std::uint64_t seed = 1) {
  RandomScans source(params, {.seed = seed});
  return test::all_of(source);
}

TEST(RandomScans, LieInFreeCellsFarEnoughFromOthers) {
  const test::Plan plan(test::room_plan);
  const OccupancyGrid grid = plan.grid();
  RandomScans::Params params = params_of(plan);
  params.count = 200;
  params.clearance = 0.4;
  const auto samples = read_all(params);
  ASSERT_EQ(samples.size(), 200U);
  std::set<std::pair<int, int>> cells;
  for (const Sample& sample : samples) {
    const Pose3& pose = *sample.map_from_robot;
    EXPECT_EQ(grid.at(pose.x, pose.y), Cell::free);
    for (int i = 0; i < 64; ++i) {
      const double angle = 2.0 * pi * i / 64;
      EXPECT_EQ(grid.at(pose.x + 0.4 * std::cos(angle), pose.y + 0.4 * std::sin(angle)), Cell::free);
    }
    cells.emplace(static_cast<int>(pose.x / 0.5), static_cast<int>(pose.y / 0.5));
  }
  // All there are: one cell away from the walls, and from the pillar in column 5.
  std::set<std::pair<int, int>> expected;
  for (const int column : {2, 3, 7, 8, 9}) {
    for (const int row : {2, 3, 4}) expected.emplace(column, row);
  }
  EXPECT_EQ(cells, expected);
}

TEST(RandomScans, LookInAllDirections) {
  const test::Plan plan(test::room_plan);
  RandomScans::Params params = params_of(plan);
  params.count = 400;
  std::array<int, 4> quadrants{};
  for (const Sample& sample : read_all(params)) {
    ++quadrants[static_cast<std::size_t>(std::floor((sample.map_from_robot->heading() + pi) / (pi / 2))) % 4];
  }
  // 100 each; 5 standard deviations are 43.
  for (const int n : quadrants) EXPECT_NEAR(n, 100, 43);
}

TEST(RandomScans, SeeTheCellsAroundThem) {
  const test::Plan plan(test::room_plan);
  RandomScans::Params params = params_of(plan);
  params.count = 50;
  params.laser.noise = 0.0;
  params.laser.max_range = 2.0;
  params.max_unknown = 0.0;
  const auto samples = read_all(params);
  const OccupancyGrid grid = plan.grid();
  for (const Sample& sample : samples) {
    const Transform map_from_robot(seen_from_above(*sample.map_from_robot));
    const Scan& scan = sample.observation.scan;
    EXPECT_GT(scan.hits.size(), 0U);
    EXPECT_LE(scan.hits.size() + scan.free_ends.size(), 361U);
    for (std::size_t i = 0; i < scan.hits.size(); ++i) {
      const Point& hit = scan.hits[i];
      const Point p = map_from_robot(hit);
      // A ray ends on the border between a free cell and an occupied one; it may graze a corner.
      const auto borders_on = [&](Cell kind) {
        constexpr double step = 5e-4;
        return grid.at(p.x + step, p.y) == kind || grid.at(p.x - step, p.y) == kind ||
               grid.at(p.x, p.y + step) == kind || grid.at(p.x, p.y - step) == kind;
      };
      EXPECT_TRUE(borders_on(Cell::occupied));
      EXPECT_TRUE(borders_on(Cell::free));
      EXPECT_LT(std::hypot(hit.x, hit.y), 2.0);
    }
    for (std::size_t i = 0; i < scan.free_ends.size(); ++i) {
      const Point& end = scan.free_ends[i];
      EXPECT_NEAR(std::hypot(end.x, end.y), 2.0, 1e-5);
      EXPECT_EQ(grid.at(map_from_robot(end).x, map_from_robot(end).y), Cell::free);
    }
  }
}

TEST(RandomScans, AreSegmentsOfTheirOwn) {
  const test::Plan plan(test::room_plan);
  const auto samples = read_all(params_of(plan));
  ASSERT_EQ(samples.size(), 100U);
  for (std::size_t i = 0; i < samples.size(); ++i) EXPECT_EQ(samples[i].segment, static_cast<int>(i));
}

TEST(RandomScans, DependOnTheirSeedOnly) {
  const test::Plan plan(test::room_plan);
  const auto a = read_all(params_of(plan), 7);
  const auto b = read_all(params_of(plan), 7);
  const auto c = read_all(params_of(plan), 8);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(*a[i].map_from_robot, *b[i].map_from_robot);
    EXPECT_EQ(a[i].observation.scan.hits, b[i].observation.scan.hits);
    EXPECT_NE(*a[i].map_from_robot, *c[i].map_from_robot);
    EXPECT_NE(a[i].observation.scan.hits, c[i].observation.scan.hits);
  }
}

TEST(RandomScans, SayWhyThereAreNone) {
  const test::Plan plan(test::room_plan);
  RandomScans::Params params = params_of(plan);
  params.clearance = 2.0;
  EXPECT_EQ(fault_of(params, plan),
            "map.yaml: error: has no free cell 2 m away from all that is not free; lower clearance, or take "
            "another map");
  params.map.path = test::file_path("missing.yaml");
  EXPECT_NE(fault_of(params, plan).find("missing.yaml"), std::string::npos);
}

TEST(RandomScans, OfAMapFarAwayAreTheSameFarAway) {
  const std::vector<Sample> near = read_all(params_of(test::Plan(test::room_plan, "[0, 0, 0]")));
  const std::vector<Sample> far = read_all(params_of(test::Plan(test::room_plan, "[500000, 4649776, 0]")));
  ASSERT_EQ(far.size(), near.size());
  for (std::size_t i = 0; i < near.size(); ++i) {
    EXPECT_EQ(far[i].observation.scan.hits, near[i].observation.scan.hits);
    EXPECT_NEAR(far[i].map_from_robot->x, near[i].map_from_robot->x + 500'000.0, 1e-9);
    EXPECT_NEAR(far[i].map_from_robot->y, near[i].map_from_robot->y + 4'649'776.0, 1e-9);
  }
}

}  // namespace
}  // namespace glocal::simulation::random_scans_test
