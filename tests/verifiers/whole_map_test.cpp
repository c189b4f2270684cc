#include "verifiers/whole_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

namespace glocal::verifiers::whole_map_test {
namespace {

/// An L of walls: where its corner is, and how it lies, is plain to see.
Points corner(float x0, float y0) {
  Points points;
  for (int i = 0; i < 60; ++i) {
    const float along = 0.05F * static_cast<float>(i);
    points.push_back({x0 + along, y0, 0.0F});
    if (i < 40) points.push_back({x0, y0 + along, 0.0F});
  }
  return points;
}

std::shared_ptr<const GlobalMap> map_of(const std::vector<Points>& parts) {
  MapData data;
  for (const Points& part : parts) {
    for (std::size_t i = 0; i < part.size(); ++i) data.points.push_back(part[i]);
  }
  return std::make_shared<const GlobalMap>(std::move(data));
}

/// What a robot 1 m before both walls of a corner sees.
LocalMap before_a_corner() {
  LocalMap local;
  local.points = corner(-1.0F, -1.0F);
  local.ends = {local.points.size()};
  return local;
}

Verification verification(const std::shared_ptr<const GlobalMap>& map, const Pose2& declared,
                          const PoseGate& gate = {}) {
  WholeMap verifier({}, StageSetup{.map = map});
  return verifier.verify(before_a_corner(), Pose3(declared), gate);
}

TEST(WholeMap, CertifiesAPoseWithoutEqual) {
  const auto found = verification(map_of({corner(0.0F, 0.0F)}), {1.0, 1.0, 0.0});
  ASSERT_TRUE(found.certificate);
  EXPECT_EQ(found.certificate->contact, 1.0);
  EXPECT_LT(found.certificate->at_most, 1.0);
  EXPECT_GE(found.certificate->at_most, 0.89);
  EXPECT_DOUBLE_EQ(found.certificate->epsilon, 0.1);
  EXPECT_GT(found.certificate->delta, 0.0);
  EXPECT_GT(found.points_tested, 0U);
  for (const Hypothesis& rival : found.rivals) EXPECT_LT(rival.quality, found.certificate->contact);
}

TEST(WholeMap, BringsTheOtherCorner) {
  const auto found = verification(map_of({corner(0.0F, 0.0F), corner(7.03F, 4.01F)}), {1.0, 1.0, 0.0});
  ASSERT_FALSE(found.rivals.empty());
  const Hypothesis& rival = found.rivals.front();
  EXPECT_NEAR(rival.map_from_local.x, 8.03, 0.1);
  EXPECT_NEAR(rival.map_from_local.y, 5.01, 0.1);
  EXPECT_EQ(rival.quality, 1.0);
  EXPECT_EQ(rival.score, 1.0);
  ASSERT_TRUE(found.certificate);
  EXPECT_EQ(found.certificate->at_most, 1.0);
}

TEST(WholeMap, BringsEachRivalOnce) {
  // The other corner's surroundings fit, too, if less well, and lead to the same pose.
  const auto found = verification(map_of({corner(0.0F, 0.0F), corner(7.03F, 4.01F)}), {1.0, 1.0, 0.0});
  for (std::size_t i = 0; i < found.rivals.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const Pose3& a = found.rivals[i].map_from_local;
      const Pose3& b = found.rivals[k].map_from_local;
      EXPECT_TRUE(distance(a, b) >= 0.4 || rotation_between(a, b) >= radians(11.5)) << i << " and " << k;
    }
  }
}

TEST(WholeMap, FindsWhatFitsBetterInAMirror) {
  // The short wall of the map is where the local map has its long one. Only half of it fits without a mirror.
  Points mirrored = corner(0.0F, 0.0F);
  std::swap(mirrored.x, mirrored.y);
  const auto found = verification(map_of({mirrored}), {1.0, 1.0, 0.0});
  ASSERT_TRUE(found.mirrored_contact);
  EXPECT_GT(*found.mirrored_contact, 0.98);
  EXPECT_TRUE(found.is_mirrored);
  EXPECT_FALSE(verification(map_of({corner(0.0F, 0.0F)}), {1.0, 1.0, 0.0}).mirrored_contact);
  EXPECT_FALSE(verification(map_of({mirrored, corner(9.0F, 9.0F)}), {10.0, 10.0, 0.0}).mirrored_contact)
      << "the local map fits as well without";
}

TEST(WholeMap, NamesNoMirrorWhereMostOfWhatIsSeenIsNotOnTheMapEitherWay) {
  Points mirrored = corner(0.0F, 0.0F);
  std::swap(mirrored.x, mirrored.y);
  LocalMap local = before_a_corner();
  for (int i = 0; i < 100; ++i) {  // As many points again, apart from each other.
    const auto k = static_cast<float>(i);
    local.points.push_back({3.0F + 1.7F * k, 5.0F + 1.1F * k, 0.0F});
  }
  local.ends = {local.points.size()};
  WholeMap verifier({}, StageSetup{.map = map_of({mirrored})});
  const Verification found = verifier.verify(local, Pose3(Pose2{1.0, 1.0, 0.0}), {});
  EXPECT_NEAR(found.mirrored_contact.value(), 0.5, 0.05);
  EXPECT_FALSE(found.is_mirrored);
}

/// What the verifier says in the end, and in which call.
std::pair<Verification, int> asked_again(WholeMap& verifier, const LocalMap& local, const Pose2& declared) {
  for (int call = 1;; ++call) {
    Verification found = verifier.verify(local, Pose3(declared), {});
    if (!found.goes_on) return {std::move(found), call};
    EXPECT_FALSE(found.certificate);
    EXPECT_TRUE(found.rivals.empty());
  }
}

TEST(WholeMap, ASearchThatGoesOnSaysTheSameInTheEnd) {
  const auto map = map_of({corner(0.0F, 0.0F), corner(7.03F, 4.01F)});
  const Pose2 declared{1.0, 1.0, 0.0};
  const Verification whole = verification(map, declared);
  int calls_before = std::numeric_limits<int>::max();
  for (const std::size_t looks : {1U, 1000U, 1'000'000'000U}) {
    WholeMap verifier({}, StageSetup{.map = map, .looks_per_step = looks});
    const auto [found, calls] = asked_again(verifier, before_a_corner(), declared);
    EXPECT_EQ(found.certificate.value().at_most, whole.certificate.value().at_most);
    ASSERT_EQ(found.rivals.size(), whole.rivals.size());
    EXPECT_EQ(found.rivals.front().map_from_local, whole.rivals.front().map_from_local);
    EXPECT_LT(calls, calls_before);
    calls_before = calls;
  }
  EXPECT_EQ(calls_before, 1);
}

TEST(WholeMap, WithoutAStepASearchGoesOnByTheLooksItIsGiven) {
  const auto map = map_of({corner(0.0F, 0.0F), corner(7.03F, 4.01F)});
  const Pose3 declared{Pose2{1.0, 1.0, 0.0}};
  const Verification whole = verification(map, {1.0, 1.0, 0.0});
  const LocalMap local = before_a_corner();
  int calls_before = std::numeric_limits<int>::max();
  for (const std::size_t looks : {std::size_t{1}, std::size_t{10000}, BoxSearch::to_the_end}) {
    WholeMap verifier({}, StageSetup{.map = map, .looks_per_step = 1});
    Verification found = verifier.verify(local, declared, {});
    ASSERT_TRUE(found.goes_on);
    std::size_t tested = found.points_tested;
    int calls = 0;
    for (; found.goes_on; ++calls) {
      found = verifier.go_on(local, declared, {}, looks);
      tested += found.points_tested;
    }
    EXPECT_EQ(found.certificate.value().at_most, whole.certificate.value().at_most);
    EXPECT_EQ(tested, whole.points_tested);
    EXPECT_LT(calls, calls_before);
    calls_before = calls;
  }
  EXPECT_EQ(calls_before, 1);
}

TEST(WholeMap, ASearchGoesOnForTheSamePoseInTheSameFrameOnly) {
  const auto map = map_of({corner(0.0F, 0.0F), corner(7.03F, 4.01F)});
  WholeMap verifier({}, StageSetup{.map = map, .looks_per_step = 2000});
  const Pose2 declared{1.0, 1.0, 0.0};
  LocalMap local = before_a_corner();
  const int calls = asked_again(verifier, local, declared).second;
  ASSERT_GT(calls, 3);
  const Pose2 other{8.03, 5.01, 0.0};
  const int calls_for_other = asked_again(verifier, local, other).second;
  const auto begin = [&] { ASSERT_TRUE(verifier.verify(local, Pose3(declared), {}).goes_on); };
  begin();
  EXPECT_EQ(asked_again(verifier, local, {1.1, 1.0, 0.0}).second, calls - 1) << "nearly the same pose";
  begin();
  EXPECT_EQ(asked_again(verifier, local, other).second, calls_for_other) << "another pose";
  begin();
  verifier.reset();
  EXPECT_EQ(asked_again(verifier, local, declared).second, calls) << "after a reset";
  begin();
  ++local.epoch;
  EXPECT_EQ(asked_again(verifier, local, declared).second, calls) << "in another frame";
}

TEST(WholeMap, RivalsOutsideOfAPriorAreNone) {
  const Prior prior{.region = {.x = 1.0, .y = 1.0, .radius = 2.0}, .heading = {}};
  const auto found = verification(map_of({corner(0.0F, 0.0F), corner(7.0F, 4.0F)}), {1.0, 1.0, 0.0},
                                  PoseGate(prior, Pose3{}));
  for (const Hypothesis& rival : found.rivals) EXPECT_LT(rival.map_from_local.x, 3.0);
}

TEST(WholeMap, AMirrorOutsideOfAPriorIsNone) {
  // Where the robot is, the map has the long wall alone; 20 m away the mirrored local map fits as a whole.
  Points wall;
  for (int i = 0; i < 60; ++i) wall.push_back({0.05F * static_cast<float>(i), 0.0F, 0.0F});
  Points mirrored = corner(20.0F, 20.0F);
  std::swap(mirrored.x, mirrored.y);
  const auto map = map_of({wall, mirrored});
  EXPECT_TRUE(verification(map, {1.0, 1.0, 0.0}).mirrored_contact);
  const Prior prior{.region = {.x = 1.0, .y = 1.0, .radius = 3.0}, .heading = {}};
  EXPECT_FALSE(verification(map, {1.0, 1.0, 0.0}, PoseGate(prior, Pose3{})).mirrored_contact);
}

TEST(WholeMap, BoxesAreLargerOnLargeMaps) {
  const auto delta_with = [](float width) {
    return verification(map_of({corner(0.0F, 0.0F), corner(width, width)}), {1.0, 1.0, 0.0})
        .certificate->delta;
  };
  EXPECT_NEAR(delta_with(100.0F), 2.0 * std::sqrt(2.0) * 0.025, 1e-9);
  EXPECT_NEAR(delta_with(200.0F), 2.0 * std::sqrt(2.0) * 0.05, 1e-9);
  EXPECT_NEAR(delta_with(600.0F), 2.0 * std::sqrt(2.0) * 0.1, 1e-9);
}

}  // namespace
}  // namespace glocal::verifiers::whole_map_test
