// What every stage promises (glocal/strategies.hpp).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "contract/strategies.hpp"
#include "matchers/in_space/hall_map.hpp"

namespace glocal::test::stages_test {
namespace {

Observation observation(const Points& hits, double x = 0.0) {
  Observation result;
  result.scan.hits = hits;
  result.odom_from_robot.x = x;
  return result;
}

Points seen(double x) {
  return glocal::test::seen_from(glocal::test::small_world_points(), {2.0 + x, 2.0, 0.0}, 2.5);
}

/// Where the robot is, for matchers.
constexpr Pose2 map_from_robot{5.5, 2.5, 0.7};

Points seen_by_robot() {
  return glocal::test::seen_from(glocal::test::small_world_points(), map_from_robot, 3.5);
}

/// A local map that began elsewhere, with the robot turned otherwise: who mixes up its frame and the robot's
/// is more than a metre off.
LocalMap local_map() {
  LocalMap local;
  local.local_from_robot = Pose2{1.5, -0.7, 0.9};
  local.points = moved(seen_by_robot(), local.local_from_robot);
  local.ends = {local.points.size()};
  return local;
}

/// Thirty hypotheses around three places.
std::vector<Hypothesis> hypotheses() {
  Rng rng(3);
  std::vector<Hypothesis> result;
  for (int i = 0; i < 30; ++i) {
    const Pose2 pose{5.0 * (i % 3) + rng.normal(0.02), rng.normal(0.02), wrap_angle(3.1 + rng.normal(0.02))};
    result.push_back({.map_from_local = pose, .map_from_robot = pose, .score = 0.9 - 0.01 * i});
  }
  return result;
}

/// A cluster for each remainder by three.
std::vector<Cluster> clusters() {
  std::vector<Cluster> result(3);
  const auto all = hypotheses();
  for (std::size_t i = 0; i < all.size(); ++i) result[i % 3].members.push_back(i);
  for (std::size_t k = 0; k < 3; ++k) {
    result[k].map_from_robot = all[k].map_from_robot;
    result[k].variance_x = result[k].variance_y = result[k].variance_theta = 0.0004;
  }
  return result;
}

bool equal(const std::vector<Hypothesis>& a, const std::vector<Hypothesis>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Hypothesis& p, const Hypothesis& q) {
    return p.map_from_local == q.map_from_local && p.quality == q.quality && p.score == q.score;
  });
}

class Stages : public Contract {
 protected:
  [[nodiscard]] StageSetup setup(int threads = 1) const { return {map_, threads}; }
  std::shared_ptr<const GlobalMap> map_ = glocal::test::small_world();
};

TEST_F(Stages, LocalMappersPlaceTheFirstObservationAtTheOrigin) {
  for_each(catalog_.local_mappers, [&](const StrategyChoice& choice) {
    const auto mapper = catalog_.local_mappers.make(choice, setup());
    mapper->add(observation(seen(0.0), 17.0));
    EXPECT_EQ(mapper->map().local_from_robot, Pose2{});
    ASSERT_EQ(mapper->map().ends.size(), 1U);
    EXPECT_EQ(mapper->map().ends.back(), mapper->map().points.size());
    EXPECT_GT(mapper->map().points.size(), 0U);
  });
}

TEST_F(Stages, LocalMappersKeepTheIndexesOfAnEpochAndMoveOnWithoutHits) {
  for_each(catalog_.local_mappers, [&](const StrategyChoice& choice) {
    const auto mapper = catalog_.local_mappers.make(choice, setup());
    mapper->add(observation(seen(0.0)));
    const LocalMap before = mapper->map();
    mapper->add(observation(seen(0.3), 0.3));
    const LocalMap after = mapper->map();
    ASSERT_EQ(after.epoch, before.epoch);
    ASSERT_GE(after.points.size(), before.points.size());
    // A mapper may refine a point, but not give its index to another one.
    for (std::size_t i = 0; i < before.points.size(); ++i) {
      EXPECT_NEAR(after.points.x[i], before.points.x[i], 0.05);
      EXPECT_NEAR(after.points.y[i], before.points.y[i], 0.05);
    }
    EXPECT_EQ(after.ends.size(), 2U);
    EXPECT_EQ(after.ends.front(), before.ends.front());
    EXPECT_EQ(after.ends.back(), after.points.size());
    EXPECT_NEAR(after.local_from_robot.x, 0.3, 0.1);

    mapper->add(observation({}, 0.8));
    EXPECT_EQ(mapper->map().points, after.points);
    EXPECT_NEAR(mapper->map().local_from_robot.x, after.local_from_robot.x + 0.5, 1e-9);
  });
}

TEST_F(Stages, LocalMappersRepeatThemselvesAfterAReset) {
  for_each(catalog_.local_mappers, [&](const StrategyChoice& choice) {
    const auto mapper = catalog_.local_mappers.make(choice, setup());
    const auto drive = [&] {
      for (const double x : {0.0, 0.3, 0.6}) mapper->add(observation(seen(x), x));
      return mapper->map();
    };
    const LocalMap first = drive();
    mapper->reset();
    EXPECT_TRUE(mapper->map().points.empty());
    const LocalMap second = drive();
    EXPECT_EQ(first.points, second.points);
    EXPECT_EQ(first.ends, second.ends);
    EXPECT_EQ(first.local_from_robot, second.local_from_robot);
  });
}

TEST_F(Stages, ContactIndexesCountWhatIsClearlyInContactAndNothingElse) {
  constexpr double epsilon = 0.1;
  const Points& wall = map_->points();
  const auto nearest = [&](const Point& p) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < wall.size(); ++i)
      least = std::min(least, std::hypot(double{p.x} - wall.x[i], double{p.y} - wall.y[i]));
    return least;
  };
  Points near;
  Points far;
  Rng rng(5);
  while (near.size() < 100 || far.size() < 100) {
    const auto x = static_cast<float>(rng.uniform(-2.0, 12.0));
    const auto y = static_cast<float>(rng.uniform(-2.0, 10.0));
    const double distance = nearest({x, y, 0.0F});
    if (distance < 0.8 * epsilon) near.push_back({x, y, 0.0F});
    if (distance > 1.2 * epsilon) far.push_back({x, y, 0.0F});
  }
  far.push_back({1e30F, 0.0F, 0.0F});
  far.push_back({0.0F, std::numeric_limits<float>::quiet_NaN(), 0.0F});

  for_each(catalog_.contact_indexes, [&](const StrategyChoice& choice) {
    const auto index = catalog_.contact_indexes.make(choice, {&wall, epsilon});
    EXPECT_EQ(index->count(near, 0, near.size(), Transform(Pose2{})), near.size());
    EXPECT_EQ(index->count(far, 0, far.size(), Transform(Pose2{})), 0U);
    const MotionBatch at_rest = [] {
      MotionBatch motions;
      motions.cosine.fill(1.0F);
      return motions;
    }();
    ContactIndex::BatchColumn begins{};
    ContactIndex::BatchColumn at_most{};
    index->count_at_most(near, 8, at_rest, 1, begins, at_most);
    EXPECT_EQ(at_most[0], 8U);
    EXPECT_GT(index->memory_bytes(), 0U);
  });
}

TEST_F(Stages, MatchersKeepToTheThresholdInFallingScore) {
  for_each(catalog_.matchers, [&](const StrategyChoice& choice) {
    const auto matcher = catalog_.matchers.make(choice, setup());
    Rng rng(1);
    const auto found = matcher->match(local_map(), observation(seen_by_robot()), 0.5, rng).hypotheses;
    ASSERT_FALSE(found.empty());
    double last = 1.0;
    for (const Hypothesis& h : found) {
      EXPECT_GE(h.score, 0.5);
      EXPECT_LE(h.score, last);
      last = h.score;
    }
  });
}

// Exactly so up to what a contact index may be wrong by.
TEST_F(Stages, TheQualityOfAHypothesisIsTheContactOfTheLocalMap) {
  const LocalMap local = local_map();
  for_each(catalog_.matchers, [&](const StrategyChoice& choice) {
    const auto matcher = catalog_.matchers.make(choice, setup());
    const double epsilon = contact_epsilon(choice.name);
    const KdTreeContact surely(map_->points(), 0.8 * epsilon);
    const KdTreeContact perhaps(map_->points(), 1.2 * epsilon);
    Rng rng(1);
    const auto found = matcher->match(local, observation(seen_by_robot()), 0.3, rng).hypotheses;
    ASSERT_FALSE(found.empty());
    for (const Hypothesis& h : found) {
      const Transform map_from_local(seen_from_above(h.map_from_local));
      EXPECT_GE(h.quality, surely.share(local.points, map_from_local));
      EXPECT_LE(h.quality, perhaps.share(local.points, map_from_local));
    }
  });
}

TEST_F(Stages, MatchersFindTheRobotInWhateverFrameTheLocalMapIs) {
  const LocalMap local = local_map();
  for_each(catalog_.matchers, [&](const StrategyChoice& choice) {
    const auto matcher = catalog_.matchers.make(choice, setup());
    Rng rng(1);
    const auto found = matcher->match(local, observation(seen_by_robot()), 0.5, rng).hypotheses;
    ASSERT_FALSE(found.empty());
    const Pose3 best = found.front().map_from_local * local.local_from_robot;
    EXPECT_LT(distance(best, map_from_robot), 0.4);
    EXPECT_LT(rotation_between(best, map_from_robot), radians(15.0));
  });
}

TEST_F(Stages, MatchersAnswerAlikeForAnyNumberOfThreadsAndAfterAReset) {
  for_each(catalog_.matchers, [&](const StrategyChoice& choice) {
    const auto one = catalog_.matchers.make(choice, setup(1));
    const auto two = catalog_.matchers.make(choice, setup(2));
    const auto answer = [](Matcher& matcher) {
      Rng rng(1);
      return matcher.match(local_map(), observation(seen_by_robot()), 0.5, rng);
    };
    const MatchResult first = answer(*one);
    const MatchResult parallel = answer(*two);
    one->reset();
    const MatchResult again = answer(*one);
    EXPECT_TRUE(equal(first.hypotheses, parallel.hypotheses));
    EXPECT_TRUE(equal(first.hypotheses, again.hypotheses));
    EXPECT_EQ(first.proposals, parallel.proposals);
    EXPECT_EQ(first.points_tested, parallel.points_tested);
  });
}

TEST_F(Stages, WhatCanBeSavedOfAMatchersIndexIsTheSameEachTime) {
  std::size_t saved = 0;
  for_each(catalog_.matchers, [&](const StrategyChoice& choice) {
    StageSetup anew = setup(2);
    anew.use_saved = false;
    const auto one = catalog_.matchers.make(choice, setup());
    const auto index = one->saved_index();
    EXPECT_EQ(index, catalog_.matchers.make(choice, anew)->saved_index());
    if (!index) return;
    ++saved;
    EXPECT_FALSE(index->empty());
    EXPECT_TRUE(one->map_index());
  });
  EXPECT_GT(saved, 0U);
}

TEST_F(Stages, MatchersFindNothingForAnEmptyLocalMap) {
  for_each(catalog_.matchers, [&](const StrategyChoice& choice) {
    Rng rng(1);
    EXPECT_TRUE(catalog_.matchers.make(choice, setup())->match({}, {}, 0.0, rng).hypotheses.empty());
  });
}

TEST_F(Stages, ClusterersPutEveryHypothesisIntoOneCluster) {
  for_each(catalog_.clusterers, [&](const StrategyChoice& choice) {
    const auto clusterer = catalog_.clusterers.make(choice, setup());
    const auto all = hypotheses();
    Rng rng(1);
    const auto first = clusterer->cluster(all, rng);
    std::vector<int> times(all.size(), 0);
    for (const Cluster& cluster : first) {
      EXPECT_FALSE(cluster.members.empty());
      EXPECT_TRUE(std::is_sorted(cluster.members.begin(), cluster.members.end()));
      for (const std::size_t member : cluster.members) ++times.at(member);
    }
    EXPECT_EQ(times, std::vector<int>(all.size(), 1));
    Rng same(1);
    const auto second = clusterer->cluster(all, same);
    ASSERT_EQ(first.size(), second.size());
    for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(first[i].members, second[i].members);
    EXPECT_TRUE(clusterer->cluster({}, rng).empty());
  });
}

TEST_F(Stages, RatersRateEveryClusterAndNormalise) {
  for_each(catalog_.raters, [&](const StrategyChoice& choice) {
    const auto rater = catalog_.raters.make(choice, setup());
    const auto ratings = rater->rate(clusters(), hypotheses());
    ASSERT_EQ(ratings.size(), 3U);
    double sum = 0.0;
    for (const Rating& rating : ratings) {
      EXPECT_GT(rating.r, 0.0);
      EXPECT_LE(rating.r, 1.0);
      sum += rating.r_normalised;
    }
    EXPECT_NEAR(sum, 1.0, 1e-12);
    EXPECT_TRUE(rater->rate({}, {}).empty());
  });
}

TEST_F(Stages, ThresholdsStayInRangeAndChangeOnlyWhenUpdatedOrReset) {
  for_each(catalog_.threshold_policies, [&](const StrategyChoice& choice) {
    const auto policy = catalog_.threshold_policies.make(choice, setup());
    const double initial = policy->omega_max();
    EXPECT_EQ(policy->omega_max(), initial);
    for (int i = 0; i < 30; ++i) {
      policy->update(i < 15 ? hypotheses() : std::vector<Hypothesis>{});
      EXPECT_GE(policy->omega_max(), 0.0);
      EXPECT_LE(policy->omega_max(), 1.0);
    }
    policy->reset();
    EXPECT_EQ(policy->omega_max(), initial);
  });
}

TEST_F(Stages, VerdictsAreWholeNeverUnknownPlaceAndForgottenByAReset) {
  for_each(catalog_.verdict_rules, [&](const StrategyChoice& choice) {
    const auto rule = catalog_.verdict_rules.make(choice, setup());
    EXPECT_EQ(rule->judge({}).kind, VerdictKind::searching);
    StepResult step;
    // Ten hypotheses at one place, and their cluster.
    Cluster cluster = clusters().front();
    for (std::size_t& member : cluster.members) {
      step.hypotheses.push_back(hypotheses()[member]);
      member = step.hypotheses.size() - 1;
    }
    step.clusters = {cluster};
    step.ratings = {{0.9, 1.0}};
    const auto drive = [&] {
      std::vector<VerdictKind> kinds;
      for (step.step = 0; step.step < 20; ++step.step) {
        const Verdict verdict = rule->judge(step);
        EXPECT_NE(verdict.kind, VerdictKind::unknown_place);
        EXPECT_EQ(verdict.map_from_robot.has_value(), verdict.kind == VerdictKind::localized);
        EXPECT_EQ(verdict.candidates.empty(), verdict.kind != VerdictKind::ambiguous);
        EXPECT_FALSE(verdict.why.empty());
        kinds.push_back(verdict.kind);
      }
      return kinds;
    };
    rule->reset();
    const auto first = drive();
    // A single undisputed cluster that stays is convincing sooner or later.
    EXPECT_EQ(first.back(), VerdictKind::localized);
    rule->reset();
    EXPECT_EQ(drive(), first);
  });
}

/// What a verifier promises of its answer, and the same answer by two threads.
void expect_as_promised(Verifier& verifier, Verifier& by_two_threads, const LocalMap& local,
                        const Pose3& map_from_robot_declared) {
  const Pose3 declared = map_from_robot_declared * inverse(local.local_from_robot);
  const Verification found = verifier.verify(local, declared, {});
  const Verification again = by_two_threads.verify(local, declared, {});
  ASSERT_EQ(found.rivals.size(), again.rivals.size());
  EXPECT_EQ(found.points_tested, again.points_tested);
  EXPECT_GT(found.points_tested, 0U);
  ASSERT_EQ(found.certificate.has_value(), again.certificate.has_value());
  if (found.certificate) {
    EXPECT_EQ(found.certificate->at_most, again.certificate->at_most);
  }
  double before = 1.0;
  for (std::size_t i = 0; i < found.rivals.size(); ++i) {
    const Hypothesis& rival = found.rivals[i];
    EXPECT_EQ(rival.map_from_local, again.rivals[i].map_from_local);
    EXPECT_LE(rival.score, before);
    before = rival.score;
    const Pose3 other = rival.map_from_local * local.local_from_robot;
    EXPECT_TRUE(distance(other, map_from_robot_declared) > found.distance ||
                rotation_between(other, map_from_robot_declared) > found.rotation);
  }
}

TEST_F(Stages, RivalsFallAreNoneNearTheDeclaredPoseAndTheSameForAnyNumberOfThreads) {
  for_each(catalog_.verifiers, [&](const StrategyChoice& choice) {
    const auto verifier = catalog_.verifiers.make(choice, setup());
    if (!verifier->verifies()) return;
    expect_as_promised(*verifier, *catalog_.verifiers.make(choice, setup(2)), local_map(), map_from_robot);
  });
}

TEST_F(Stages, SoItIsInSpace) {
  const Pose3 declared({4.5, 5.0, 1.2}, turn_about_z(0.6) * exponential({0.03, -0.02, 0.0}));
  LocalMap local;
  local.local_from_robot = {{0.8, -0.5, 0.3}, exponential({0.03, -0.02, 0.0})};
  local.points = moved(scan_of(hall(), declared), local.local_from_robot);
  local.ends = {local.points.size()};
  for_each(catalog_.verifiers, [&](const StrategyChoice& choice) {
    if (!catalog_.verifiers.find(choice.name)->motions.upright) return;
    const auto made = [&](int threads) {
      return catalog_.verifiers.make(
          choice, {.map = hall_map(), .threads = threads, .contact_epsilon = 0.2, .motion = Motion::upright});
    };
    if (made(1)->verifies()) expect_as_promised(*made(1), *made(2), local, declared);
  });
}

}  // namespace
}  // namespace glocal::test::stages_test
