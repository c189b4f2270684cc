#include "sources/bags/pose_track.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace glocal::test::bags::pose_track_test {
namespace {

using glocal::bags::EvenMotion;
using glocal::bags::PoseTrack;

PoseTrack track_of(const std::vector<std::pair<std::int64_t, Pose2>>& poses) {
  PoseTrack track;
  for (const auto& [stamp, pose] : poses) track.add(stamp, pose);
  track.settle();
  return track;
}

TEST(PoseTrack, InterpolatesWayAndTurn) {
  const PoseTrack track = track_of({{100, {1.0, 2.0, 0.0}}, {200, {3.0, 1.0, 1.0}}});
  const auto pose = track.at(125, 100);
  ASSERT_TRUE(pose);
  EXPECT_NEAR(pose->x, 1.5, 1e-12);
  EXPECT_NEAR(pose->y, 1.75, 1e-12);
  EXPECT_NEAR(pose->heading(), 0.25, 1e-12);
  EXPECT_TRUE(pose->is_planar());
}

TEST(PoseTrack, TurnsTheShortWayAcrossTheBackwardDirection) {
  const PoseTrack track = track_of({{0, {0.0, 0.0, 3.0}}, {10, {0.0, 0.0, -3.0}}});
  EXPECT_NEAR(std::abs(track.at(5, 10)->heading()), std::numbers::pi, 1e-9);
}

TEST(PoseTrack, KnowsNothingInLongGapsAndOutside) {
  const PoseTrack track = track_of({{100, {0.0, 0.0, 0.0}}, {200, {1.0, 0.0, 0.0}}});
  EXPECT_FALSE(track.at(150, 99));
  EXPECT_FALSE(track.at(99, 1000));
  EXPECT_FALSE(track.at(201, 1000));
  EXPECT_EQ(track.at(100, 1)->x, 0.0);
  EXPECT_EQ(track.at(200, 1)->x, 1.0);
}

TEST(PoseTrack, ThatIsStillHoldsWhereItIsKnown) {
  const PoseTrack track = track_of({{100, {1.0, 0.0, 0.5}}, {900, {1.0, 0.0, 0.5}}});
  EXPECT_TRUE(track.is_still());
  EXPECT_FALSE(track.at(5000, 10'000));
  EXPECT_EQ(track.at(500, 1000)->x, 1.0);
}

TEST(PoseTrack, ForgetsAllButWhatATimeNeeds) {
  PoseTrack track = track_of({{100, {1.0, 0.0, 0.0}}, {200, {2.0, 0.0, 0.0}}, {300, {3.0, 0.0, 0.0}}});
  track.forget_before(250);
  EXPECT_EQ(track.size(), 2U);
  EXPECT_FALSE(track.at(199, 1000));
  EXPECT_EQ(track.at(250, 1000)->x, 2.5);
  track.forget_before(50);
  EXPECT_EQ(track.size(), 2U);
}

TEST(PoseTrack, SortsAndKeepsTheLastOfEqualStamps) {
  const PoseTrack track = track_of({{200, {2.0, 0.0, 0.0}}, {100, {7.0, 0.0, 0.0}}, {100, {1.0, 0.0, 0.0}}});
  EXPECT_EQ(track.size(), 2U);
  EXPECT_FALSE(track.at(99, 1000));
  EXPECT_FALSE(track.at(201, 1000));
  EXPECT_EQ(track.at(200, 1)->x, 2.0);
  EXPECT_EQ(track.at(100, 1)->x, 1.0);
  EXPECT_NEAR(track.at(150, 100)->x, 1.5, 1e-12);
}

TEST(EvenMotion, InSpaceTurnsAboutOneAxis) {
  const Quaternion quarter_about_x = exponential({std::numbers::pi / 2.0, 0.0, 0.0});
  const Pose3 half = EvenMotion(Pose3(), Pose3({0.0, 0.0, 2.0}, quarter_about_x)).at(0.5);
  EXPECT_NEAR(half.z, 1.0, 1e-12);
  EXPECT_NEAR(angle_of(half.rotation), std::numbers::pi / 4.0, 1e-12);
  EXPECT_NEAR(half.rotation.y(), 0.0, 1e-12);
}

}  // namespace
}  // namespace glocal::test::bags::pose_track_test
