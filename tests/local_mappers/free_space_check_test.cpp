#include "local_mappers/free_space_check.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "local_mappers/rooms.hpp"

namespace glocal::local_mappers::free_space_check_test {
namespace {

using test::circle_around;

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
  scan.hits.push_back(all[std::size_t{14} * 49]);
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
