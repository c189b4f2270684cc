#include "matchers/ransac/ransac.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "matchers/common/point_pair.hpp"
#include "matchers/same_answer.hpp"
#include "test_world.hpp"

namespace glocal::ransac::ransac_test {
namespace {

using test::local_map_at;

MatchResult match(const Ransac::Params& params, const LocalMap& local, double omega_max = 0.6,
                  std::uint64_t seed = 1, int threads = 1) {
  Ransac matcher(params, {test::small_world(), threads});
  Rng rng(seed);
  return matcher.match({local, {}, omega_max}, rng);
}

TEST(PointPair, IsLaidMiddleOnMiddle) {
  MotionBatch motions;
  // 2 m to the right becomes 3 m upwards: middle (1, 0) to middle (5, 2.5), by a quarter turn.
  lay({Point{0.0F, 0.0F}, Point{2.0F, 0.0F}}, {Point{5.0F, 1.0F}, Point{5.0F, 4.0F}}, motions, 3);
  const Pose2 pose = motions[3].pose();
  EXPECT_NEAR(pose.theta, radians(90.0), 1e-6);
  EXPECT_NEAR(pose.x, 5.0, 1e-6);
  EXPECT_NEAR(pose.y, 1.5, 1e-6);
}

TEST(Ransac, FindsThePose) {
  Rng rng(3);
  int right = 0;
  constexpr int places = 10;
  for (int i = 0; i < places; ++i) {
    const Pose2 truth = test::somewhere_in_small_world(i, rng);
    const auto found = match({.iterations = 300000}, local_map_at(truth, 5.0)).hypotheses;
    if (found.empty()) continue;
    const Pose3& best = found.front().map_from_local;
    if (distance(best, truth) < 0.05 && rotation_between(best, truth) < radians(1.0)) ++right;
  }
  EXPECT_GE(right, places - 1);
}

TEST(Ransac, AFewDrawsSeldomDo) {
  int found = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    found +=
        match({.iterations = 50}, local_map_at({2.0, 2.0, 0.5}, 5.0), 0.6, seed).hypotheses.empty() ? 0 : 1;
  }
  EXPECT_LE(found, 2);
}

/// Of all samples whose local distance counts, as many become hypotheses as there are pairs of map points at
/// that distance.
TEST(Ransac, TestsSamplesWhoseDistancesAgree) {
  LocalMap local;
  local.points.push_back({0.0F, 0.0F, 0.0F});
  local.points.push_back({3.0F, 0.0F, 0.0F});
  local.ends = {2};
  constexpr double tolerance = 0.1;
  const Points map = test::small_world_points();
  std::size_t agree = 0;
  for (std::size_t i = 0; i < map.size(); ++i) {
    for (std::size_t k = 0; k < map.size(); ++k) {
      const double d = std::hypot(map.x[i] - map.x[k], map.y[i] - map.y[k]);
      agree += std::abs(d - 3.0) <= tolerance ? 1 : 0;
    }
  }
  constexpr int iterations = 200000;
  // Half of the draws take the same local point twice.
  const double expected =
      0.5 * iterations * static_cast<double>(agree) / static_cast<double>(map.size() * map.size());
  const MatchResult result = match({.iterations = iterations}, local, 1.0);
  EXPECT_NEAR(static_cast<double>(result.proposals), expected, 5.0 * std::sqrt(expected));
}

TEST(Ransac, QualityIsTheContactOfAllPoints) {
  const LocalMap local = local_map_at({5.5, 2.5, 0.7}, 4.0);
  const auto contact = contact_index(*test::small_world(), "bitset", 0.1);
  const auto found = match({.iterations = 200000}, local, 0.5).hypotheses;
  ASSERT_FALSE(found.empty());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_GE(found[i].quality, 0.5);
    if (i > 0) {
      EXPECT_LE(found[i].quality, found[i - 1].quality);
    }
    // A pose that has been through an arc tangent moves points by some micrometres.
    EXPECT_NEAR(found[i].quality,
                contact->share(local.points, Transform(seen_from_above(found[i].map_from_local))), 0.02);
  }
}

TEST(Ransac, AnswersAlikeForAnyNumberOfThreads) {
  const LocalMap local = local_map_at({2.0, 7.0, 0.7}, 4.0);
  const MatchResult one = match({.iterations = 200000}, local, 0.4, 7, 1);
  const MatchResult two = match({.iterations = 200000}, local, 0.4, 7, 2);
  test::expect_same_answer(one, two);
}

TEST(Ransac, AnEmptyLocalMapFitsNowhere) {
  EXPECT_TRUE(match({}, LocalMap{}, 0.0).hypotheses.empty());
}

}  // namespace
}  // namespace glocal::ransac::ransac_test
