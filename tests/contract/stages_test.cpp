// What every strategy promises (glocal/contract.hpp), and what those that are built in do besides.
#include <gmock/gmock.h>

#include <utility>

#include "contract/strategies.hpp"
#include "contract/trial_room.hpp"
#include "glocal/contract.hpp"

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

class Stages : public Contract {
 protected:
  [[nodiscard]] StageSetup setup(int threads = 1) const { return {map_, threads}; }
  std::shared_ptr<const GlobalMap> map_ = glocal::test::small_world();
};

TEST_F(Stages, AllStrategiesKeepTheirPromises) {
  for (const RegistryBase* registry : std::as_const(catalog_).registries()) {
    ASSERT_FALSE(registry->all().empty()) << registry->kind();
    for (const StrategyInfo* info : registry->all()) {
      EXPECT_THAT(broken_promises(registry->kind(), choice(*registry, *info), catalog_), testing::IsEmpty())
          << registry->kind() << " " << info->name;
    }
  }
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

TEST_F(Stages, MatchersFindTheRobotInWhateverFrameTheLocalMapIs) {
  const LocalMap local = local_map();
  for_each(catalog_.matchers, [&](const StrategyChoice& choice) {
    const auto matcher = catalog_.matchers.make(choice, setup());
    Rng rng(1);
    const auto found = matcher->match({local, observation(seen_by_robot()), 0.5}, rng).hypotheses;
    ASSERT_FALSE(found.empty());
    const Pose3 best = found.front().map_from_local * local.local_from_robot;
    EXPECT_LT(distance(best, map_from_robot), 0.4);
    EXPECT_LT(rotation_between(best, map_from_robot), radians(15.0));
  });
}

// A single undisputed cluster that stays is convincing sooner or later.
TEST_F(Stages, VerdictRulesDeclareWhatIsClear) {
  for_each(catalog_.verdict_rules, [&](const StrategyChoice& choice) {
    const auto rule = catalog_.verdict_rules.make(choice, setup());
    Verdict verdict;
    for (StepResult step = clear_step(); step.step < 20; ++step.step) verdict = rule->judge(step);
    EXPECT_EQ(verdict.kind, VerdictKind::localized);
  });
}

}  // namespace
}  // namespace glocal::test::stages_test
