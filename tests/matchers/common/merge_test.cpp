#include "matchers/common/merge.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "glocal/rng.hpp"

namespace glocal::merge_test {
namespace {

/// Falling score; groups of poses within 1 cm and 0.2 degrees, every 3 m.
std::vector<Hypothesis> groups(std::size_t count, std::size_t per_group) {
  Rng rng(1);
  std::vector<Hypothesis> hypotheses;
  const auto n = static_cast<double>(count * per_group);
  for (std::size_t i = 0; i < count * per_group; ++i) {
    const auto group = static_cast<double>(i % count);
    const Pose2 pose{3.0 * group + 0.02 + rng.uniform(0.0, 0.01), -2.0 + 0.02 + rng.uniform(0.0, 0.01),
                     0.01 + rng.uniform(0.0, 0.003)};
    hypotheses.push_back({.map_from_local = pose, .score = 1.0 - static_cast<double>(i) / n});
  }
  return hypotheses;
}

std::size_t total_support(const std::vector<Hypothesis>& hypotheses) {
  return std::accumulate(hypotheses.begin(), hypotheses.end(), std::size_t{0},
                         [](std::size_t sum, const Hypothesis& h) { return sum + h.support; });
}

TEST(MergeHypotheses, LeavesAloneWhatFits) {
  std::vector<Hypothesis> hypotheses = groups(20, 5);
  merge_hypotheses(hypotheses, {}, 100);
  EXPECT_EQ(hypotheses.size(), 100U);
  for (const Hypothesis& h : hypotheses) EXPECT_EQ(h.support, 1U);
}

TEST(MergeHypotheses, KeepsTheBestOfEveryDistinctPose) {
  std::vector<Hypothesis> hypotheses = groups(20, 500);
  const std::vector<Hypothesis> before = hypotheses;
  merge_hypotheses(hypotheses, {}, 100);
  ASSERT_EQ(hypotheses.size(), 20U);
  for (std::size_t i = 0; i < hypotheses.size(); ++i) {
    EXPECT_EQ(hypotheses[i].support, 500U);
    EXPECT_EQ(hypotheses[i].map_from_local, before[i].map_from_local);  // the first of a group is its best
  }
}

TEST(MergeHypotheses, ThePartOfTheTurnBehind180DegreesIsTheOneBeforeMinus180) {
  // Where the turn falls into an odd number of parts: twelve poses 8 degrees apart, seen at half of that.
  std::vector<Hypothesis> hypotheses;
  for (int i = 0; i < 12; ++i) {
    for (const double theta : {radians(179.0), radians(-179.0)})
      hypotheses.push_back({.map_from_local = Pose2{0.02 + 1.0 * i, 0.02, theta}, .score = 1.0});
  }
  merge_hypotheses(hypotheses, {}, 12);
  EXPECT_EQ(hypotheses.size(), 12U);
}

TEST(MergeHypotheses, PosesAreDistinctWhereTheRobotIsNotTheLocalFrame) {
  // 300 m from the local origin, what is turned by half a degree is far off.
  const Pose2 local_from_robot{300.0, 0.0, 0.0};
  std::vector<Hypothesis> hypotheses;
  for (int i = 0; i < 20; ++i)
    hypotheses.push_back({.map_from_local = Pose2{0.02, 0.02, radians(0.5 * (i % 2))}, .score = 1.0});
  merge_hypotheses(hypotheses, local_from_robot, 10);
  EXPECT_EQ(hypotheses.size(), 2U);
}

TEST(MergeHypotheses, FitsHoweverSpreadTheyAreAndLosesNoSupport) {
  Rng rng(2);
  std::vector<Hypothesis> hypotheses;
  for (int i = 0; i < 20000; ++i) {
    const Pose2 pose{rng.uniform(-30.0, 30.0), rng.uniform(-30.0, 30.0), rng.uniform(-3.14, 3.14)};
    hypotheses.push_back({.map_from_local = pose, .score = 1.0 - i / 20000.0});
  }
  const std::vector<Hypothesis> before = hypotheses;
  merge_hypotheses(hypotheses, {}, 1000);
  EXPECT_LE(hypotheses.size(), 1000U);
  EXPECT_EQ(total_support(hypotheses), 20000U);
  EXPECT_TRUE(std::is_sorted(hypotheses.begin(), hypotheses.end(),
                             [](const Hypothesis& a, const Hypothesis& b) { return a.score > b.score; }));
  merge_hypotheses(hypotheses, {}, 8);
  EXPECT_LE(hypotheses.size(), 8U);
}

TEST(MergeHypotheses, InSpaceHeightAndTiltTellPosesApart) {
  // Two heights and two ways to lean at one place, with the same heading.
  Rng rng(3);
  std::vector<Hypothesis> hypotheses;
  for (int i = 0; i < 400; ++i) {
    const double roll = radians(28.0) * (i / 2 % 2) + rng.uniform(-0.01, 0.01);
    const Pose3 pose({rng.uniform(-0.01, 0.01), 0.0, 1.0 * (i % 2)}, exponential({roll, 0.0, 0.0}));
    hypotheses.push_back({.map_from_local = pose, .score = 1.0 - i / 400.0});
  }
  merge_hypotheses(hypotheses, {}, 100);
  ASSERT_EQ(hypotheses.size(), 4U);
  for (const Hypothesis& h : hypotheses) EXPECT_EQ(h.support, 100U);
}

TEST(MergeHypotheses, InSpaceTheyFitHoweverSpreadTheyAre) {
  Rng rng(4);
  std::vector<Hypothesis> hypotheses;
  for (int i = 0; i < 5000; ++i) {
    const auto draw = [&](double most) { return rng.uniform(-most, most); };
    const Vector3 place{draw(30.0), draw(30.0), draw(5.0)};
    const Vector3 turn{draw(2.0), draw(2.0), draw(2.0)};
    hypotheses.push_back({.map_from_local = Pose3(place, exponential(turn)), .score = 1.0 - i / 5000.0});
  }
  merge_hypotheses(hypotheses, {}, 8);
  EXPECT_LE(hypotheses.size(), 8U);
  EXPECT_EQ(total_support(hypotheses), 5000U);
}

}  // namespace
}  // namespace glocal::merge_test
