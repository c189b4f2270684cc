#include "matchers/mcl/mcl.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "glocal/error.hpp"
#include "matchers/same_answer.hpp"
#include "test_world.hpp"

namespace glocal::mcl::mcl_test {
namespace {

/// The small world with its walls in the grid.
std::shared_ptr<const GlobalMap> walled_world() {
  MapData data;
  data.points = test::small_world_points();
  data.grid = test::small_world()->grid();
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    const auto cell = [](float value) { return static_cast<int>(std::floor((value + 0.05F) / 0.1F)); };
    data.grid.cell(cell(data.points.x[i]), cell(data.points.y[i])) = Cell::occupied;
  }
  return std::make_shared<const GlobalMap>(std::move(data));
}

/// What the robot sees from a pose; odometry counts from somewhere else.
Observation observation_at(const Pose2& map_from_robot) {
  Observation observation;
  observation.scan.hits = test::seen_from(test::small_world_points(), map_from_robot, 3.5);
  observation.odom_from_robot = Pose2{40.0, -3.0, 2.0} * map_from_robot;
  return observation;
}

/// The local map of an observation: just the scan.
LocalMap local_map_of(const Observation& observation) {
  LocalMap local;
  local.points = observation.scan.hits;
  local.ends = {local.points.size()};
  return local;
}

Mcl::Params many_particles(const std::string& model) {
  return {.max_particles = 8000,
          .update_min_d = 0.0,
          .update_min_a_deg = 0.0,
          .noise = {0.05, 0.05, 0.05, 0.05},
          .laser_model_type = model,
          .likelihood_exponent = 0.2,
          .laser_max_range = 10.0};
}

/// A drive from one room into the other.
std::vector<Pose2> way_through_small_world() {
  std::vector<Pose2> way;
  Pose2 pose{6.0, 1.5, 3.0};
  for (int i = 0; i < 30; ++i) {
    way.push_back(pose);
    pose = pose * Pose2{0.2, 0.0, i > 12 && i < 20 ? -0.25 : 0.0};
  }
  return way;
}

/// The pose that most particles agree on.
Hypothesis heaviest(const std::vector<Hypothesis>& hypotheses) {
  return *std::max_element(hypotheses.begin(), hypotheses.end(),
                           [](const Hypothesis& a, const Hypothesis& b) { return a.support < b.support; });
}

std::size_t total_support(const std::vector<Hypothesis>& hypotheses) {
  return std::accumulate(hypotheses.begin(), hypotheses.end(), std::size_t{0},
                         [](std::size_t sum, const Hypothesis& h) { return sum + h.support; });
}

class MclModels : public ::testing::TestWithParam<const char*> {};

TEST_P(MclModels, ConvergesFromAnywhereAndTracks) {
  Mcl matcher(many_particles(GetParam()), {walled_world(), 1});
  std::size_t step = 0;
  Pose2 truth;
  MatchResult result;
  for (const Pose2& pose : way_through_small_world()) {
    truth = pose;
    const Observation observation = observation_at(pose);
    Rng rng(step++);
    result = matcher.match({local_map_of(observation), observation, 0.0}, rng);
    EXPECT_TRUE(step > 1 || result.proposals == 8000U);
  }
  ASSERT_FALSE(result.hypotheses.empty());
  const Hypothesis best = heaviest(result.hypotheses);
  EXPECT_LT(distance(best.map_from_local, truth), 0.25);
  EXPECT_LT(rotation_between(best.map_from_local, truth), radians(6.0));
  // KLD-sampling needs few particles where they agree.
  EXPECT_LT(result.proposals, 1500U);
  EXPECT_GE(result.proposals, 500U);
}

INSTANTIATE_TEST_SUITE_P(All, MclModels,
                         ::testing::Values("beam", "beam_prob", "likelihood_field", "likelihood_field_prob"));

TEST(Mcl, HypothesesAreTheParticlesInTheFrameOfTheLocalMap) {
  const Observation observation = observation_at({2.0, 2.0, 0.5});
  LocalMap local = local_map_of(observation);
  local.local_from_robot = Pose2{1.0, -2.0, 0.8};
  Mcl matcher(many_particles("likelihood_field"), {walled_world(), 1});
  Rng rng(1);
  const auto found = matcher.match({local, observation, 0.0}, rng).hypotheses;
  ASSERT_EQ(found.size(), 1000U);
  const auto contact = contact_index(*walled_world(), "kd_tree", 0.1);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Hypothesis& h = found[i];
    const Pose3 robot = h.map_from_local * local.local_from_robot;
    // The grid of contacts blurs what the tree knows exactly.
    EXPECT_NEAR(h.score, contact->share(observation.scan.hits, Transform(seen_from_above(robot))), 0.15);
    EXPECT_NEAR(h.quality, contact->share(local.points, Transform(seen_from_above(h.map_from_local))), 0.15);
    EXPECT_LE(h.score, found[i == 0 ? 0 : i - 1].score);
  }
  EXPECT_LE(total_support(found), 8000U);
}

TEST(Mcl, SupportAddsUpToTheParticles) {
  Mcl::Params params = many_particles("likelihood_field");
  params.merging.max_hypotheses = 100000;
  Mcl matcher(params, {walled_world(), 1});
  const Observation observation = observation_at({2.0, 2.0, 0.5});
  Rng rng(1);
  (void)matcher.match({local_map_of(observation), observation, 0.0}, rng);
  const MatchResult second = matcher.match({local_map_of(observation), observation, 0.0}, rng);
  // `proposals` are those before resampling; as the world is small, there may be fewer after it.
  EXPECT_LE(total_support(second.hypotheses), second.proposals);
  EXPECT_GE(total_support(second.hypotheses), 500U);
}

TEST(Mcl, WithoutAScanThereIsNoAnswerButTheMotionCounts) {
  Mcl::Params params = many_particles("likelihood_field_prob");
  params.noise = {0.0, 0.0, 0.0, 0.0};
  params.max_particles = 1;
  Mcl matcher(params, {walled_world(), 1});
  const Pose2 start{2.0, 2.0, 0.5};
  const Pose2 step{0.3, 0.1, 0.4};
  const auto match = [&](const Pose2& pose, bool sees) {
    Observation observation = observation_at(pose);
    const LocalMap local = local_map_of(observation);
    if (!sees) observation.scan.hits.clear();
    Rng rng(1);
    return matcher.match({local, observation, 0.0}, rng).hypotheses;
  };
  const auto first = match(start, true);
  ASSERT_EQ(first.size(), 1U);
  EXPECT_TRUE(match(start * step, false).empty());
  const auto third = match(start * step * step, true);
  ASSERT_EQ(third.size(), 1U);
  const Pose3 expected = first.front().map_from_local * step * step;
  EXPECT_LT(distance(third.front().map_from_local, expected), 1e-9);
  EXPECT_LT(rotation_between(third.front().map_from_local, expected), 1e-9);
}

TEST(Mcl, ASmallMotionMovesTheAnswerButIsNoUpdate) {
  Mcl::Params params = many_particles("likelihood_field");
  params.update_min_d = 0.25;
  params.update_min_a_deg = 11.0;
  Mcl matcher(params, {walled_world(), 1});
  const Pose2 start{2.0, 2.0, 0.5};
  const Pose2 little{0.2, 0.0, 0.1};
  const auto match = [&](const Pose2& pose) {
    const Observation observation = observation_at(pose);
    Rng rng(1);
    return matcher.match({local_map_of(observation), observation, 0.0}, rng);
  };
  const Pose3 before = heaviest(match(start).hypotheses).map_from_local;
  const MatchResult result = match(start * little);
  EXPECT_EQ(result.points_tested, 0U);
  const Pose3 expected = before * little;
  EXPECT_TRUE(std::any_of(result.hypotheses.begin(), result.hypotheses.end(),
                          [&](const Hypothesis& h) { return distance(h.map_from_local, expected) < 1e-9; }));
  EXPECT_GT(match(start * little * little).points_tested, 0U);
}

/// Share of the particles within 1 m of a pose.
double share_near(const std::vector<Hypothesis>& hypotheses, const Pose2& pose) {
  double near = 0.0;
  for (const Hypothesis& h : hypotheses) {
    if (distance(h.map_from_local, pose) < 1.0) near += static_cast<double>(h.support);
  }
  return near / static_cast<double>(total_support(hypotheses));
}

TEST(Mcl, FindsAKidnappedRobotAgainOnlyWithNewParticles) {
  const auto share_after = [](double slow, double fast) {
    Mcl::Params params = many_particles("likelihood_field_prob");
    params.recovery_alpha_slow = slow;
    params.recovery_alpha_fast = fast;
    Mcl matcher(params, {walled_world(), 1});
    std::uint64_t step = 0;
    std::vector<Hypothesis> found;
    const auto observe = [&](const Observation& observation) {
      Rng rng(step++);
      found = matcher.match({local_map_of(observation), observation, 0.0}, rng).hypotheses;
    };
    const auto way = way_through_small_world();
    for (const Pose2& pose : way) observe(observation_at(pose));
    // Carried back to where it began, without odometry telling.
    const Pose2 carried = way.front();
    const Observation last = observation_at(way.back());
    for (int i = 0; i < 20; ++i) {
      Observation observation = observation_at(carried);
      observation.odom_from_robot = last.odom_from_robot;
      observe(observation);
    }
    return share_near(found, carried);
  };
  EXPECT_EQ(share_after(0.0, 0.0), 0.0);
  EXPECT_GT(share_after(0.1, 0.6), 0.5);
}

TEST(Mcl, AnswersAlikeForAnyNumberOfThreads) {
  Mcl one(many_particles("likelihood_field"), {walled_world(), 1});
  Mcl two(many_particles("likelihood_field"), {walled_world(), 2});
  std::uint64_t step = 0;
  for (const Pose2& pose : way_through_small_world()) {
    const Observation observation = observation_at(pose);
    Rng rng(step);
    Rng same(step++);
    test::expect_same_answer(one.match({local_map_of(observation), observation, 0.0}, rng),
                             two.match({local_map_of(observation), observation, 0.0}, same));
  }
}

TEST(Mcl, RefusesAMapWithoutFreeSpace) {
  MapData data;
  data.points = test::small_world_points();
  const auto map = std::make_shared<const GlobalMap>(std::move(data));
  EXPECT_THROW(Mcl({}, {map, 1}), ConfigError);
}

}  // namespace
}  // namespace glocal::mcl::mcl_test
