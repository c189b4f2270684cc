#include "local_mappers/scan_matching.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "local_mappers/drives.hpp"

namespace glocal::local_mappers::scan_matching_test {
namespace {

using test::at;
using test::bad_odometry;
using test::circle;
using test::Drive;
using test::drive;
using test::kidnapping;
using ::testing::ElementsAre;

struct WorstError {
  double translation = 0.0;
  double rotation = 0.0;
};

WorstError worst_error(ScanMatching& mapper, const Drive& drive) {
  WorstError worst;
  for (std::size_t i = 0; i < drive.observations.size(); ++i) {
    mapper.add(drive.observations[i]);
    const Pose2 truth = inverse(drive.map_from_robot.front()) * drive.map_from_robot[i];
    worst.translation = std::max(worst.translation, distance(truth, mapper.map().local_from_robot));
    worst.rotation = std::max(worst.rotation, rotation_between(truth, mapper.map().local_from_robot));
  }
  return worst;
}

TEST(ScanMatching, ExactScansGiveThePoseInSpiteOfBadOdometry) {
  ScanMatching mapper({});
  const WorstError worst = worst_error(mapper, drive(test::furnished_room(), circle(120), {}, bad_odometry));
  EXPECT_LT(worst.translation, 0.03);
  EXPECT_LT(worst.rotation, radians(0.3));
  EXPECT_EQ(mapper.map().epoch, 0);
}

TEST(ScanMatching, NoisyScansGiveThePoseInSpiteOfBadOdometry) {
  const Drive noisy = drive(test::furnished_room(), circle(120), {.noise = 0.02}, bad_odometry);
  ScanMatching mapper({});
  const WorstError worst = worst_error(mapper, noisy);
  EXPECT_LT(worst.translation, 0.05);
  EXPECT_LT(worst.rotation, radians(0.6));
  // The same drive by odometry alone is lost: the test is one.
  const Pose3 odom =
      inverse(noisy.observations.front().odom_from_robot) * noisy.observations.back().odom_from_robot;
  const Pose2 truth = inverse(noisy.map_from_robot.front()) * noisy.map_from_robot.back();
  EXPECT_GT(distance(odom, truth), 0.5);
}

TEST(ScanMatching, PointsLieOnTheWallsAndHaveNormalsAcrossThem) {
  const Drive exact = drive(test::furnished_room(), circle(60), {}, bad_odometry);
  ScanMatching mapper({});
  for (const Observation& observation : exact.observations) mapper.add(observation);
  const LocalMap& map = mapper.map();
  ASSERT_EQ(map.normals.size(), map.points.size());
  const Transform map_from_local(exact.map_from_robot.front());
  const Transform rotation({0, 0, exact.map_from_robot.front().theta});
  std::size_t on_south_wall = 0;
  for (std::size_t i = 0; i < map.points.size(); ++i) {
    const Point p = map_from_local(map.points[i]);
    // The south wall, away from its corners, seen from inside.
    if (p.y > 0.5F || p.x < 1.0F || p.x > 11.0F) continue;
    ++on_south_wall;
    EXPECT_NEAR(p.y, 0.0, 0.04);
    EXPECT_GT(rotation(map.normals[i]).y, 0.95F);
  }
  EXPECT_GT(on_south_wall, 100U);
}

TEST(ScanMatching, ABareCorridorKeepsTheOdometryAlongIt) {
  std::vector<Pose2> poses;
  for (int i = 0; i < 60; ++i) poses.push_back({0.25 * i, 0.0, 0.0});
  ScanMatching mapper({});
  const Drive straight = drive(test::bare_corridor(), poses, {.max_range = 8.0, .noise = 0.01}, {});
  const WorstError worst = worst_error(mapper, straight);
  EXPECT_LT(worst.translation, 0.5);
  EXPECT_LT(worst.rotation, radians(1.0));
  EXPECT_LT(std::abs(mapper.map().local_from_robot.y), 0.05);
}

TEST(ScanMatching, ASearchOfHeadingsAloneAddsNoShiftAlongABareCorridor) {
  // The corridor begins behind the robot, askew to the cells of the map; only its walls are in view.
  std::vector<test::Wall> walls;
  const Transform turned({0.0, 0.0, 0.3});
  for (const float side : {-1.0F, 1.0F}) {
    const Point from = turned({-20.0F, side, 0.0F});
    const Point to = turned({60.0F, side, 0.0F});
    walls.push_back({from.x, from.y, to.x, to.y});
  }
  std::vector<Pose2> poses;
  for (int i = 0; i < 40; ++i) poses.push_back(Pose2{0.0, 0.0, 0.3} * Pose2{0.57 * i, 0.0, 0.02 * (i % 3)});
  const Drive straight = drive(walls, poses, {.max_range = 8.0, .noise = 0.005}, {});
  ScanMatching::Params params;
  params.search.translation = 0.0;
  ScanMatching mapper(params);
  EXPECT_LT(worst_error(mapper, straight).translation, 0.1);
  ScanMatching shifting({});
  EXPECT_GT(worst_error(shifting, straight).translation, 0.2);  // the drive is a test
}

TEST(ScanMatching, ACellsPointIsTheMeanOfItsFirstThreeHits) {
  ScanMatching mapper({});
  // With so few hits odometry is kept; all of these fall into the cell from (1.00, 0.00) to (1.05, 0.05).
  mapper.add(at(0.0, {{1.01F, 0.01F, 0}, {2.02F, 0.02F, 0}}));
  mapper.add(at(0.0, {{1.02F, 0.03F, 0}}));
  EXPECT_NEAR(mapper.map().points.x[0], 1.015F, 1e-6F);
  mapper.add(at(0.01, {{1.02F, 0.02F, 0}}));  // at 1.03 in the local frame
  EXPECT_NEAR(mapper.map().points.x[0], 1.02F, 1e-6F);
  EXPECT_NEAR(mapper.map().points.y[0], 0.02F, 1e-6F);
  mapper.add(at(0.0, {{1.049F, 0.049F, 0}, {3.01F, 0.01F, 0}}));
  EXPECT_NEAR(mapper.map().points.x[0], 1.02F, 1e-6F);
  EXPECT_EQ(mapper.map().points.size(), 3U);
  EXPECT_THAT(mapper.map().ends, ElementsAre(2U, 2U, 2U, 3U));
}

TEST(ScanMatching, HitsAtDifferentHeightsStayApart) {
  ScanMatching mapper({});
  mapper.add(at(0.0, {{1.01F, 0.01F, 0.01F}, {1.01F, 0.01F, 0.51F}, {1.01F, 0.01F, 1.01F}}));
  mapper.add(at(0.0, {{1.03F, 0.03F, 0.53F}, {1.03F, 0.03F, 1.03F}, {1.03F, 0.03F, -0.5F}}));
  const Points& points = mapper.map().points;
  ASSERT_EQ(points.size(), 4U);
  EXPECT_THAT(mapper.map().ends, ElementsAre(3U, 4U));
  EXPECT_NEAR(points.z[1], 0.52F, 1e-6F);
  EXPECT_NEAR(points.z[2], 1.02F, 1e-6F);
  EXPECT_NEAR(points.z[3], -0.5F, 1e-6F);
}

TEST(ScanMatching, AnObservationWithoutHitsOnlyMovesTheRobot) {
  ScanMatching mapper({});
  mapper.add(at(5.0, {}));
  EXPECT_EQ(mapper.map().local_from_robot, Pose2{});
  mapper.add(at(6.0, {}));
  EXPECT_NEAR(mapper.map().local_from_robot.x, 1.0, 1e-12);
  mapper.add(at(7.0, {{1.01F, 0.01F, 0}}));
  EXPECT_NEAR(mapper.map().points.x[0], 3.01F, 1e-5F);
  EXPECT_THAT(mapper.map().ends, ElementsAre(0U, 0U, 1U));
}

TEST(ScanMatching, TheSameDriveGivesTheSameMapAlsoAfterAReset) {
  const Drive noisy = drive(test::furnished_room(), circle(40), {.noise = 0.02}, bad_odometry);
  ScanMatching first({});
  ScanMatching second({});
  worst_error(first, noisy);
  for (std::size_t i = 0; i < 17; ++i) second.add(noisy.observations[3 * i % 40]);
  second.reset();
  EXPECT_TRUE(second.map().points.empty());
  worst_error(second, noisy);
  EXPECT_EQ(first.map().points, second.map().points);
  EXPECT_EQ(first.map().normals, second.map().normals);
  EXPECT_EQ(first.map().local_from_robot, second.map().local_from_robot);
  EXPECT_EQ(first.map().ends, second.map().ends);
  EXPECT_EQ(first.map().epoch, second.map().epoch);
}

TEST(ScanMatching, RegisteredPointsKeepTheirIndexAndStayInTheirCell) {
  const Drive noisy = drive(test::furnished_room(), circle(40), {.noise = 0.02}, bad_odometry);
  ScanMatching mapper({});
  Points before;
  for (const Observation& observation : noisy.observations) {
    mapper.add(observation);
    const Points& now = mapper.map().points;
    ASSERT_GE(now.size(), before.size());
    for (std::size_t i = 0; i < before.size(); ++i) {
      ASSERT_LT(std::hypot(now.x[i] - before.x[i], now.y[i] - before.y[i]), 0.05 * std::sqrt(2.0));
    }
    before = now;
    ASSERT_EQ(mapper.map().ends.back(), now.size());
  }
}

TEST(ScanMatching, StartsANewMapWhenObservationsStopFitting) {
  Drive kidnapped = kidnapping();
  kidnapped.observations.pop_back();  // One that fits is enough.
  ScanMatching mapper({});
  std::vector<int> epochs;
  std::vector<std::size_t> sizes;
  for (const Observation& observation : kidnapped.observations) {
    mapper.add(observation);
    epochs.push_back(mapper.map().epoch);
    sizes.push_back(mapper.map().points.size());
  }
  EXPECT_THAT(std::vector(epochs.begin() + 9, epochs.end()), ElementsAre(0, 0, 1, 1));
  // What does not fit leaves the old map as it was.
  EXPECT_EQ(sizes[10], sizes[9]);
  EXPECT_LT(sizes[11], sizes[9]);
  EXPECT_EQ(mapper.map().ends.size(), 2U);
  EXPECT_NEAR(mapper.map().local_from_robot.x, 0.0, 1e-3);
  EXPECT_NEAR(mapper.map().local_from_robot.heading(), 0.0, 1e-3);
  mapper.reset();
  EXPECT_EQ(mapper.map().epoch, 0);
}

TEST(ScanMatching, StartsANewMapWhereAScanFitsOnlyFarFromOdometry) {
  // Somebody turns the robot by 60 degrees, and its wheels say nothing of it.
  std::vector<Pose2> poses = circle(10);
  Pose2 turned = poses.back();
  turned.theta = wrap_angle(turned.theta + radians(60));
  poses.insert(poses.end(), 2, turned);
  Drive carried = drive(test::furnished_room(), poses, {}, {});
  ScanMatching mapper({});
  for (std::size_t i = 0; i < 10; ++i) mapper.add(carried.observations[i]);
  const std::size_t points = mapper.map().points.size();
  for (std::size_t i = 10; i < 12; ++i)
    carried.observations[i].odom_from_robot = carried.observations[9].odom_from_robot;
  mapper.add(carried.observations[10]);
  EXPECT_EQ(mapper.map().epoch, 0);
  EXPECT_EQ(mapper.map().points.size(), points);
  mapper.add(carried.observations[11]);
  EXPECT_EQ(mapper.map().epoch, 1);
  EXPECT_EQ(mapper.map().ends.size(), 1U);
  EXPECT_EQ(mapper.robot(), Pose2{});
}

/// Two corridors with the same walls and other boxes along them.
std::vector<test::Wall> corridor_with_boxes(const std::vector<double>& places, double side) {
  std::vector<test::Wall> walls = test::bare_corridor();
  for (const double x : places) {
    walls.push_back({x, side, x, 0.3 * side});
    walls.push_back({x, 0.3 * side, x + 0.8, 0.3 * side});
    walls.push_back({x + 0.8, 0.3 * side, x + 0.8, side});
    side = -side;
  }
  return walls;
}

TEST(ScanMatching, StartsANewMapWhereBeamsPassThroughWhatWasThere) {
  std::vector<Pose2> way;
  for (int i = 0; i < 10; ++i) way.push_back({0.2 * i, 0.0, 0.0});
  Drive kidnapped = drive(corridor_with_boxes({2.6, 4.2, 7.0}, 1.0), way, {}, {});
  const Drive other = drive(corridor_with_boxes({3.0, 5.4}, -1.0), way, {}, {});
  kidnapped.observations.insert(kidnapped.observations.end(), other.observations.begin() + 9,
                                other.observations.end());
  kidnapped.observations.push_back(other.observations.back());

  ScanMatching mapper({});
  ScanMatching::Params anything;
  anything.max_free_space_violation = 1.0;
  ScanMatching credulous(anything);
  for (const Observation& observation : kidnapped.observations) {
    EXPECT_EQ(mapper.map().epoch, 0);
    mapper.add(observation);
    credulous.add(observation);
  }
  EXPECT_EQ(mapper.map().epoch, 1);
  EXPECT_EQ(mapper.map().ends.size(), 1U);
  EXPECT_EQ(credulous.map().epoch, 0);  // the walls fit
}

TEST(ScanMatching, ASingleMisfitIsForgiven) {
  Drive drive = kidnapping();
  drive.observations.resize(11);
  drive.observations.push_back(drive.observations[9]);
  ScanMatching mapper({});
  for (const Observation& observation : drive.observations) mapper.add(observation);
  EXPECT_EQ(mapper.map().epoch, 0);
  EXPECT_EQ(mapper.map().ends.size(), 12U);
}

TEST(ScanMatching, LeavesOutHitsBeyondItsSquareAndStartsAnewWhenTheRobotLeavesIt) {
  ScanMatching mapper({});
  mapper.add(at(0.0, {{1.01F, 0.01F, 0}, {1e6F, 0, 0}, {0, -1e30F, 0}, {900, 0, 0}}));
  EXPECT_EQ(mapper.map().points.size(), 1U);
  mapper.add(at(700.0, {{1.01F, 0.01F, 0}}));
  EXPECT_EQ(mapper.map().epoch, 0);
  mapper.add(at(900.0, {{1.01F, 0.01F, 0}}));
  EXPECT_EQ(mapper.map().epoch, 1);
  EXPECT_EQ(mapper.map().local_from_robot, Pose2{});
  EXPECT_THAT(mapper.map().ends, ElementsAre(1U));
  mapper.add(at(1e300, {{1.01F, 0.01F, 0}}));
  EXPECT_EQ(mapper.map().epoch, 2);
}

TEST(ScanMatching, MemoryDoesNotGrowInARoomThatIsKnown) {
  ScanMatching mapper({});
  const Drive round = drive(test::furnished_room(), circle(190), {.noise = 0.01}, bad_odometry);
  std::size_t after_one_round = 0;
  for (std::size_t i = 0; i < round.observations.size(); ++i) {
    mapper.add(round.observations[i]);
    if (i == 63) after_one_round = mapper.grid().memory_bytes();
  }
  // 12 m x 9 m and the stamps around them are at most 5 x 5 tiles of 3.2 m, in two more rows and columns if
  // they begin badly.
  EXPECT_LE(mapper.grid().tiles(), 36U);
  EXPECT_EQ(mapper.grid().memory_bytes(), after_one_round);
}

TEST(ScanMatching, AnObservationTouchesNoMoreTilesHoweverLongTheDrive) {
  std::vector<test::Wall> walls = test::bare_corridor();
  for (int i = -50; i < 50; ++i) {
    const double x = 2.0 * i + 0.3 * (i % 3);
    walls.push_back({x, 1, x, 0.7});
    walls.push_back({x + 0.7, -1, x + 0.7, -0.8});
  }
  std::vector<Pose2> poses;
  for (int i = 0; i < 300; ++i) poses.push_back({0.25 * i - 60.0, 0.0, 0.0});
  const Drive corridor = drive(walls, poses, {.beams = 181, .max_range = 8.0, .noise = 0.01}, bad_odometry);
  ScanMatching mapper({});
  std::size_t before = 0;
  for (std::size_t i = 0; i < corridor.observations.size(); ++i) {
    mapper.add(corridor.observations[i]);
    // A step of 0.25 m brings at most one new column of tiles into view, on a strip 2 m wide and its stamps.
    if (i > 0) {
      EXPECT_LE(mapper.grid().tiles() - before, 3U) << i;
    }
    before = mapper.grid().tiles();
  }
  EXPECT_EQ(mapper.map().epoch, 0);
  const Pose2 truth{0.25 * 299, 0.0, 0.0};
  EXPECT_LT(distance(mapper.map().local_from_robot, truth), 1.5);
}

TEST(ScanMatching, MemoryIsLimited) {
  ScanMatching::Params params;
  params.voxels.memory_mb = 1;
  ScanMatching mapper(params);
  for (int i = 0; i < 200; ++i) mapper.add(at(4.0 * i, {{1.0F, 0, 0}}));
  EXPECT_LE(mapper.grid().tiles() * PointGrid::tile_bytes(), 1000000U);
  EXPECT_GT(mapper.map().points.size(), 5U);
  EXPECT_LT(mapper.map().points.size(), 100U);
  EXPECT_EQ(mapper.map().ends.size(), 200U);
}

}  // namespace
}  // namespace glocal::local_mappers::scan_matching_test
