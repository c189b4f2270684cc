#include "local_mappers/free_space_check.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "local_mappers/rooms.hpp"

namespace glocal::local_mappers::free_space_check_test {
namespace {

/// Beams in every direction, half a degree apart, that all end after `range` m.
Scan circle_around(const Point& origin, float range) {
  Scan scan;
  scan.origin = origin;
  for (int i = 0; i < 720; ++i) {
    const float angle = static_cast<float>((i + 0.25) * std::numbers::pi / 360.0);
    scan.hits.push_back({origin.x + range * std::cos(angle), origin.y + range * std::sin(angle), 0.0F});
  }
  return scan;
}

TEST(RangeProfile, TellsWhatWasMetFromWhatWasSeenThroughAndWhatWasHidden) {
  const RangeProfile profile(circle_around({1.0F, 0.0F, 0.0F}, 5.0F));
  Points hits;
  hits.push_back({4.0F, 0.0F, 0.0F});   // 3 m from the sensor: the beam went on
  hits.push_back({1.0F, -4.6F, 0.0F});  // 4.6 m: that too
  hits.push_back({-3.8F, 0.0F, 0.0F});  // 4.8 m: met, within the margin
  hits.push_back({1.0F, 5.2F, 0.0F});   // 5.2 m: met as well
  hits.push_back({7.0F, 0.0F, 0.0F});   // 6 m: behind what was met
  const RangeProfile::Seen seen = profile.look_at(hits, {});
  EXPECT_EQ(seen.violation, 2U);
  EXPECT_EQ(seen.met, 2U);
}

TEST(RangeProfile, LooksAtHitsWhereTheirRobotWas) {
  const RangeProfile profile(circle_around({}, 5.0F));
  Points hits;
  hits.push_back({1.0F, 0.0F, 0.0F});
  // The other robot stood at (0, 4) and looked along y: its hit is at (0, 5).
  EXPECT_EQ(profile.look_at(hits, {0.0, 4.0, radians(90)}).met, 1U);
  EXPECT_EQ(profile.look_at(hits, {0.0, 2.0, radians(90)}).violation, 1U);
}

TEST(RangeProfile, SaysNothingOfDirectionsItDidNotLookIn) {
  Scan ahead;
  for (int i = -5; i <= 5; ++i) {
    ahead.free_ends.push_back({20.0F * std::cos(0.01F * static_cast<float>(i)),
                               20.0F * std::sin(0.01F * static_cast<float>(i)), 0.0F});
  }
  Points hits;
  hits.push_back({3.0F, 0.0F, 0.0F});   // on the way of free beams
  hits.push_back({0.0F, 3.0F, 0.0F});   // beside
  hits.push_back({-3.0F, 0.0F, 0.0F});  // behind
  const RangeProfile::Seen seen = RangeProfile(ahead).look_at(hits, {});
  EXPECT_EQ(seen.violation, 1U);
  EXPECT_EQ(seen.met, 0U);
}

struct FreeSpace {
  Rng rng{7};
  std::vector<test::Wall> walls = test::furnished_room();
  FreeSpaceCheck latest;

  [[nodiscard]] Scan scan_at(const Pose2& pose) { return test::scan_from(walls, pose, {.noise = 0.02}, rng); }
};

TEST(FreeSpaceCheck, ADriveThroughARoomIsInAccordWithItself) {
  FreeSpace sights;
  for (int i = 0; i < 30; ++i) {
    const Pose2 pose{1.0 + 0.2 * i, 1.5, 0.05 * i};
    const Scan scan = sights.scan_at(pose);
    EXPECT_LT(sights.latest.violation(scan, pose), 0.05) << i;
    sights.latest.add(scan, pose);
  }
}

TEST(FreeSpaceCheck, AScanFromElsewhereIsNot) {
  FreeSpace sights;
  const Pose2 before{2.0, 1.5, 0.0};
  sights.latest.add(sights.scan_at(before), before);
  for (const Pose2& truth : {Pose2{10.5, 7.0, 3.0}, Pose2{6.5, 8.5, -1.57}, Pose2{2.0, 6.5, 1.57}}) {
    EXPECT_GT(sights.latest.violation(sights.scan_at(truth), before), 0.3) << truth.x;
  }
}

TEST(FreeSpaceCheck, SaysNothingFromTooFewHits) {
  FreeSpaceCheck latest;
  latest.add(circle_around({}, 5.0F), {});
  // Each hit of this scan is seen through; the other's lie behind them.
  const Points all = circle_around({}, 1.0F).hits;
  Scan scan;
  for (std::size_t i = 0; i < 49; ++i) scan.hits.push_back(all[14 * i]);
  EXPECT_EQ(latest.violation(scan, {}), 0.0);
  scan.hits.push_back(all[14 * 49]);
  EXPECT_EQ(latest.violation(scan, {}), 1.0);
}

TEST(FreeSpaceCheck, ForgetsAllButTheLatestFourScans) {
  FreeSpaceCheck latest;
  const Scan near = circle_around({}, 2.0F);
  latest.add(circle_around({}, 5.0F), {});
  EXPECT_EQ(latest.violation(near, {}), 1.0);
  for (int i = 0; i < 3; ++i) latest.add(near, {});
  EXPECT_GT(latest.violation(near, {}), 0.0);
  latest.add(near, {});
  EXPECT_EQ(latest.violation(near, {}), 0.0);
  latest.clear();
  EXPECT_EQ(latest.violation(circle_around({}, 5.0F), {}), 0.0);
}

}  // namespace
}  // namespace glocal::local_mappers::free_space_check_test
