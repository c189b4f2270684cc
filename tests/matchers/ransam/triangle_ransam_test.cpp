#include "matchers/ransam/triangle_ransam.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "glocal/error.hpp"
#include "matchers/same_answer.hpp"
#include "matchers/surfels/hall_map.hpp"
#include "matchers/surfels/scanned_hall.hpp"

namespace glocal::ransam::triangle_ransam_test {
namespace {

LocalMap local_at(const Pose3& map_from_robot) {
  LocalMap local;
  local.points = test::scan_of(test::hall(), map_from_robot);
  local.ends = {local.points.size()};
  return local;
}

const TriangleRansam::Params params{
    {.iterations = 200000, .contact_epsilon = 0.2, .relation_cell = 0.2, .min_side = 1.5, .min_height = 1.0}};

MatchResult match(Motion motion, const LocalMap& local, double omega_max, int threads = 1) {
  TriangleRansam ransam(params, {.map = test::hall_map(), .threads = threads, .motion = motion});
  Rng rng(1);
  return ransam.match({local, {}, omega_max}, rng);
}

TEST(TriangleRansam, FindsThePoseOfATiltedSensor) {
  const Pose3 truth{{4.0, 4.5, 1.5}, exponential({0.3, -0.2, 2.0})};
  const MatchResult result = match(Motion::free, local_at(truth), 0.5);
  ASSERT_FALSE(result.hypotheses.empty());
  EXPECT_LT(distance(result.hypotheses.front().map_from_local, truth), 0.3);
  EXPECT_LT(rotation_between(result.hypotheses.front().map_from_local, truth), radians(4.0));
}

TEST(TriangleRansam, UprightPosesTurnAboutZAlone) {
  const Pose3 truth{{8.0, 4.0, 1.2}, turn_about_z(-2.5)};
  const MatchResult result = match(Motion::upright, local_at(truth), 0.4);
  ASSERT_FALSE(result.hypotheses.empty());
  for (const Hypothesis& h : result.hypotheses) {
    EXPECT_EQ(h.map_from_local.rotation.x(), 0.0);
    EXPECT_EQ(h.map_from_local.rotation.y(), 0.0);
  }
  EXPECT_LT(distance(result.hypotheses.front().map_from_local, truth), 0.3);
  EXPECT_LT(rotation_between(result.hypotheses.front().map_from_local, truth), radians(4.0));
}

TEST(TriangleRansam, HypothesesAreWhatTheContractSays) {
  const LocalMap local = local_at({{4.0, 4.5, 1.5}, exponential({0.3, -0.2, 2.0})});
  const MatchResult result = match(Motion::free, local, 0.3);
  ASSERT_FALSE(result.hypotheses.empty());
  EXPECT_GE(result.proposals, result.hypotheses.size());
  const auto contact = contact_index(*test::hall_map(), "bitset", 0.2);
  double last = 1.0;
  for (const Hypothesis& h : result.hypotheses) {
    EXPECT_GE(h.quality, 0.3);
    EXPECT_LE(h.quality, last);
    EXPECT_EQ(h.score, h.quality);
    last = h.quality;
    // Single precision here and there: a point at the edge of a voxel may change sides.
    const double omega = contact->share(moved(local.points, h.map_from_local), Transform(Pose2{}));
    EXPECT_NEAR(h.quality, omega, 2e-3);
  }
}

TEST(TriangleRansam, AnswersAlikeForAnyNumberOfThreads) {
  const LocalMap local = local_at({{4.0, 4.5, 1.5}, exponential({0.3, -0.2, 2.0})});
  test::expect_same_answer(match(Motion::free, local, 0.3, 1), match(Motion::free, local, 0.3, 2));
}

TEST(TriangleRansam, FindsNothingForAnEmptyLocalMapNorForOneWithoutSurfaces) {
  EXPECT_TRUE(match(Motion::free, {}, 0.0).hypotheses.empty());
  LocalMap point;
  point.points.push_back({1.0F, 0.0F, 0.0F});
  point.ends = {1};
  EXPECT_TRUE(match(Motion::free, point, 0.0).hypotheses.empty());
}

TEST(TriangleRansam, OneHitKilometresAwayChangesNothing) {
  const Pose3 truth{{8.0, 4.0, 1.2}, turn_about_z(-2.5)};
  LocalMap local = local_at(truth);
  local.points.push_back({3000.0F, 3000.0F, 700.0F});
  local.ends = {local.points.size()};
  const MatchResult result = match(Motion::upright, local, 0.4);
  ASSERT_FALSE(result.hypotheses.empty());
  EXPECT_LT(distance(result.hypotheses.front().map_from_local, truth), 0.3);
}

TEST(TriangleRansam, RefusesMapsWithoutSurfaces) {
  MapData line;
  for (int i = 0; i < 100; ++i) line.points.push_back({0.1F * static_cast<float>(i), 0.0F, 0.0F});
  const auto map = std::make_shared<const GlobalMap>(std::move(line));
  EXPECT_THROW(TriangleRansam(params, {.map = map, .motion = Motion::free}), ConfigError);
}

}  // namespace
}  // namespace glocal::ransam::triangle_ransam_test
