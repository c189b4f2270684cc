#include "glocal/prior.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "glocal/pose2.hpp"

namespace glocal::test::prior_test {
namespace {

Prior within(double x, double y, double radius) {
  return {.region = {x, y, radius}, .heading = {}};
}

Prior looking(double deg, double width_deg) {
  return {.region = {}, .heading = {deg, width_deg}};
}

TEST(Prior, WithoutAnythingGivenTheRobotWasAnywhere) {
  EXPECT_FALSE(Prior{}.is_given());
  EXPECT_TRUE(Prior{}.allows(Pose2{1e6, -3, 2}));
  EXPECT_TRUE(PoseGate().is_open());
  EXPECT_TRUE(PoseGate({}, Pose2{1, 2, 3}).is_open());
}

TEST(Prior, ARegionIsADiscSeenFromAbove) {
  const Prior prior = within(3, 4, 5);
  EXPECT_TRUE(prior.allows(Pose2{0, 0, 1}));  // 3, 4, 5
  EXPECT_FALSE(prior.allows(Pose2{-0.01, 0, 1}));
  EXPECT_TRUE(prior.allows(Pose2{6.5, 7.5, 0}));   // 4.95 m
  EXPECT_FALSE(prior.allows(Pose2{6.6, 7.6, 0}));  // 5.09 m
  EXPECT_TRUE(prior.allows(Pose3({3, 4, 100}, exponential({1, 0.5, 2}))));
}

TEST(Prior, HeadingsReachAcrossHalfATurn) {
  const Prior prior = looking(170, 40);
  for (const double deg : {150.1, 170.0, 180.0, -179.0, -170.1})
    EXPECT_TRUE(prior.allows(Pose2{9, 9, radians(deg)})) << deg;
  for (const double deg : {149.9, -169.9, 0.0, -10.0})
    EXPECT_FALSE(prior.allows(Pose2{9, 9, radians(deg)})) << deg;
  EXPECT_TRUE(looking(-190, 40).allows(Pose2{0, 0, radians(150.1)}));
  EXPECT_TRUE(looking(0, 360).allows(Pose2{0, 0, std::numbers::pi}));
}

TEST(Prior, RegionAndHeadingMustBothHold) {
  const Prior prior{.region = {0.0, 0.0, 1.0}, .heading = {0.0, 90.0}};
  EXPECT_TRUE(prior.allows(Pose2{0.5, 0, 0.7}));
  EXPECT_FALSE(prior.allows(Pose2{1.5, 0, 0.7}));
  EXPECT_FALSE(prior.allows(Pose2{0.5, 0, 0.8}));
}

TEST(Prior, SaysWhatItLeaves) {
  EXPECT_EQ(to_string(within(3, 4.5, 5)), "starts within 5 m of x 3, y 4.5");
  EXPECT_EQ(to_string(looking(90, 40)), "starts with headings of 90 ± 20 deg");
  EXPECT_EQ(to_string({.region = {3.0, 4.0, 5.0}, .heading = {90.0, 40.0}}),
            "starts within 5 m of x 3, y 4 with headings of 90 ± 20 deg");
}

// The robot began 2 m along x of the local frame, looking along y, and the frame lies at (10, 0), turned
// left.
TEST(PoseGate, AsksWhereALocalMapPutsTheStart) {
  const Pose2 local_from_start{2, 0, radians(90.0)};
  const Pose2 map_from_local{10, 0, radians(90.0)};  // so it began at (10, 2), looking along -x
  EXPECT_TRUE(PoseGate(within(10, 2, 0.1), local_from_start).allows(map_from_local));
  EXPECT_FALSE(PoseGate(within(10, 0, 1.9), local_from_start).allows(map_from_local));
  EXPECT_TRUE(PoseGate(looking(180, 2), local_from_start).allows(map_from_local));
  EXPECT_FALSE(PoseGate(looking(90, 178), local_from_start).allows(map_from_local));
}

TEST(StartInLocalMap, MovesAlongByOdometryWhenTheLocalMapBeginsAnew) {
  LocalMap local;
  StartInLocalMap start;
  start.follow(local, Pose2{100, 50, radians(90.0)});
  EXPECT_EQ(start.local_from_start(), Pose3());
  // The local map knows better than odometry, which says 4 m.
  local.local_from_robot = Pose2{3, 0, 0};
  start.follow(local, Pose2{100, 54, radians(90.0)});
  EXPECT_EQ(start.local_from_start(), Pose3());
  // 1 m on and half a turn: the start is 4 m ahead of the robot, whose pose is the new frame.
  local.local_from_robot = {};
  local.epoch = 1;
  start.follow(local, Pose2{100, 55, radians(-90.0)});
  EXPECT_LT(distance(start.local_from_start(), Pose2{4, 0, 0}), 1e-9);
  EXPECT_LT(rotation_between(start.local_from_start(), Pose2{0, 0, radians(180.0)}), 1e-9);
  EXPECT_TRUE(start.local_from_start().is_planar());
  // Nothing changes within an epoch, nor is anything left after a reset.
  local.local_from_robot = Pose2{7, 1, 1};
  start.follow(local, Pose2{90, 55, 0});
  EXPECT_LT(distance(start.local_from_start(), Pose2{4, 0, 0}), 1e-9);
  start.reset();
  local.local_from_robot = {};
  start.follow(local, Pose2{0, 0, 0});
  EXPECT_EQ(start.local_from_start(), Pose3());
}

/// One free cell: x from 11 to 12, y from 20 to 21.
GlobalMap map_of_one_free_cell() {
  MapData data;
  data.points.push_back({10.0F, 20.0F, 0.0F});
  data.grid = {{10, 20, 0}, 1.0, 3, 2, PackedCells(6, Cell::unknown)};
  data.grid.cell(1, 0) = Cell::free;
  return GlobalMap(std::move(data));
}

TEST(Prior, OnAMapWithCellsARegionNeedsAFreeOne) {
  const GlobalMap map = map_of_one_free_cell();
  EXPECT_EQ(why_nowhere(looking(90, 1), map), std::nullopt);
  EXPECT_EQ(why_nowhere(within(11.5, 20.5, 0.01), map), std::nullopt);
  EXPECT_EQ(why_nowhere(within(15, 24, 4.3), map), std::nullopt);  // corner (12, 21): 3, 3
  EXPECT_EQ(why_nowhere(within(15, 24, 4.2), map),
            "the map has nothing within 4.2 m of x 15, y 24: no free cell; its points have x from 10.0 m to "
            "10.0 m and y from 20.0 m to 20.0 m, so move the region there");
}

TEST(Prior, OnAMapOfPointsARegionNeedsOneThatALidarWouldSee) {
  MapData data;
  data.points.push_back({0.0F, 0.0F, 0.0F});
  data.points.push_back({2.0F, 1.0F, 0.0F});
  const GlobalMap map(std::move(data));
  EXPECT_EQ(why_nowhere(within(-104, 0, 5), map), std::nullopt);
  EXPECT_EQ(
      why_nowhere(within(-106, 0, 5), map),
      "the map has nothing within 5 m of x -106, y 0: no point is nearer than 100 m; its points have x from "
      "0.0 m to 2.0 m and y from 0.0 m to 1.0 m, so move the region there");
}

TEST(Prior, IsInTheFrameOfAMapThatIsHeldRelativeToItsOrigin) {
  MapData data = map_of_one_free_cell().data();
  data.origin = {500'000.0, 4'000'000.0, 0.0};
  const GlobalMap map(std::move(data));
  EXPECT_EQ(why_nowhere(within(500'011.5, 4'000'020.5, 0.01), map), std::nullopt);
  EXPECT_EQ(why_nowhere(within(11.5, 20.5, 0.01), map),
            "the map has nothing within 0.01 m of x 11.5, y 20.5: no free cell; its points have x from "
            "500010.0 m to 500010.0 m and y from 4000020.0 m to 4000020.0 m, so move the region there");
}

}  // namespace
}  // namespace glocal::test::prior_test
