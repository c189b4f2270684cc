#include <gtest/gtest.h>

#include <cmath>

#include "matchers/box_search/rooms_in_space.hpp"
#include "verifiers/contact_climb.hpp"
#include "verifiers/whole_map.hpp"

namespace glocal::verifiers::whole_map_in_space_test {
namespace {

using namespace test::rooms_in_space;

constexpr double epsilon = 0.2;

TEST(ContactClimb, FindsTheSummitNearby) {
  const Points map = room(0.0, 0.0, 0.0, true);
  const BitsetContact contact(map, epsilon);
  const Points points = seen_in_room();
  const Pose3 summit = map_from_local_in(0.0, 0.0, 0.0);
  const Pose3 beside(summit.translation() + Vector3{0.25, -0.2, 0.25}, turn_about_z(0.06) * summit.rotation);
  ASSERT_LT(contact.share(points, beside), 0.8);
  const Pose3 found = climbed_pose(contact, points, beside, 0.1, Motion::upright);
  EXPECT_GT(contact.share(points, found), 0.99);
  EXPECT_LT(distance(found, summit), epsilon);
  EXPECT_EQ(found.tilt(), 0.0);
}

TEST(ContactClimb, TiltsWhereTheMotionIsFree) {
  const Pose3 slope_from_room(exponential({0.13, -0.1, 0.0}));
  const BitsetContact contact(moved(room(0.0, 0.0, 0.0, true), slope_from_room), epsilon);
  const Points points = seen_in_room();
  const Pose3 summit = slope_from_room * map_from_local_in(0.0, 0.0, 0.0);
  const Pose3 beside(summit.translation(), map_from_local_in(0.0, 0.0, 0.0).rotation);
  const double upright = contact.share(points, climbed_pose(contact, points, beside, 0.1, Motion::upright));
  const Pose3 found = climbed_pose(contact, points, beside, 0.1, Motion::free);
  ASSERT_LT(upright, 0.95);
  EXPECT_GT(contact.share(points, found), 0.99);
  EXPECT_LT(rotation_between(found, summit), rotation_between(beside, summit));
}

Verification verification(const Points& map, const Pose3& map_from_local, const Points& seen = seen_in_room(),
                          Motion motion = Motion::upright) {
  MapData data;
  data.points = map;
  WholeMap verifier({.contact_epsilon = epsilon},
                    {.map = std::make_shared<const GlobalMap>(std::move(data)), .motion = motion});
  LocalMap local;
  local.points = seen;
  local.ends = {local.points.size()};
  local.local_from_robot = local_from_robot;
  return verifier.verify(local, map_from_local, {});
}

TEST(WholeMapInSpace, CertifiesAPoseWithoutEqual) {
  const auto found = verification(two_rooms(), map_from_local_in(0.0, 0.0, 0.0));
  ASSERT_TRUE(found.certificate);
  EXPECT_EQ(found.certificate->contact, 1.0);
  EXPECT_LT(found.certificate->at_most, 1.0);
  EXPECT_GE(found.certificate->at_most, 0.9);
  EXPECT_DOUBLE_EQ(found.certificate->epsilon, epsilon);
  EXPECT_NEAR(found.certificate->delta, 0.1 * std::sqrt(4.0 + 4.0 + 2.25), 1e-9);
  for (const Hypothesis& rival : found.rivals) EXPECT_LT(rival.quality, 1.0);
}

TEST(WholeMapInSpace, OfManyPointsSixHundredCount) {
  const Points in_room = seen_in_room();
  Points seen;
  for (std::size_t i = 0; i < 600; ++i) {
    seen.push_back(in_room[i % in_room.size()]);
    seen.push_back(point(50.0, 50.0, 50.0));  // one in two, so none counts
  }
  const auto found = verification(two_rooms(), map_from_local_in(0.0, 0.0, 0.0), seen);
  ASSERT_TRUE(found.certificate);
  EXPECT_EQ(found.certificate->contact, 1.0);
}

TEST(WholeMapInSpace, BoxesAreLargerOnMapsOfVeryManyCells) {
  Points map = room(0.0, 0.0, 0.0, true);
  map.push_back(point(80.0, 80.0, 80.0));
  const auto found = verification(map, map_from_local_in(0.0, 0.0, 0.0));
  ASSERT_TRUE(found.certificate);
  EXPECT_NEAR(found.certificate->delta, 0.2 * std::sqrt(4.0 + 4.0 + 2.25), 1e-9);
}

TEST(WholeMapInSpace, BringsTheRoomThatLooksAlike) {
  Points map = room(0.0, 0.0, 0.0, true);
  const Pose3 other_from_room({8.13, 2.07, 1.45}, turn_about_z(2.0));
  add(map, moved(room(0.0, 0.0, 0.0, true), other_from_room));
  const auto found = verification(map, map_from_local_in(0.0, 0.0, 0.0));
  ASSERT_TRUE(found.certificate);
  EXPECT_EQ(found.certificate->at_most, 1.0);
  ASSERT_FALSE(found.rivals.empty());
  const Hypothesis& rival = found.rivals.front();
  const Pose3 truth = other_from_room * map_from_local_in(0.0, 0.0, 0.0);
  EXPECT_LT(distance(rival.map_from_local, truth), epsilon);
  EXPECT_LT(rotation_between(rival.map_from_local, truth), radians(5.0));
  EXPECT_GT(rival.quality, 0.98);
  EXPECT_EQ(rival.score, rival.quality);
}

TEST(WholeMapInSpace, WhereTheMotionIsFreeItLooksAtTiltedPosesToo) {
  const Pose3 declared = map_from_local_in(0.0, 0.0, 0.0);
  const auto found = verification(two_rooms(), declared, seen_in_room(), Motion::free);
  ASSERT_TRUE(found.certificate);
  EXPECT_EQ(found.certificate->contact, 1.0);
  EXPECT_LT(found.certificate->at_most, 1.0);
  EXPECT_NEAR(found.certificate->delta, 0.1 * std::sqrt(6.25 + 6.25 + 6.25), 1e-9);

  // The same room on a slope: upright poses fit it less.
  const Pose3 slope_from_room({8.13, 2.07, 1.45}, turn_about_z(2.0) * exponential({0.12, 0.1, 0.0}));
  Points map = room(0.0, 0.0, 0.0, true);
  add(map, moved(room(0.0, 0.0, 0.0, true), slope_from_room));
  const auto aslant = verification(map, declared, seen_in_room(), Motion::free);
  ASSERT_FALSE(aslant.rivals.empty());
  const Hypothesis& rival = aslant.rivals.front();
  EXPECT_LT(distance(rival.map_from_local, slope_from_room * declared), epsilon);
  EXPECT_LT(rotation_between(rival.map_from_local, slope_from_room * declared), radians(5.0));
  EXPECT_GT(rival.quality, 0.98);
  for (const Hypothesis& upright : verification(map, declared).rivals) EXPECT_LT(upright.quality, 0.95);
}

}  // namespace
}  // namespace glocal::verifiers::whole_map_in_space_test
