// The line from observation to verdict, with stages that follow a script.
#include "glocal/localizer.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "files.hpp"
#include "framework/pipeline/fakes.hpp"
#include "glocal/error.hpp"
#include "glocal/parallel.hpp"

namespace glocal::test::localizer_test {
namespace {

using testing::ElementsAre;
using testing::Not;

class LocalizerTest : public testing::Test {
 protected:
  LocalizerTest() { register_fake_stages(catalog_); }

  [[nodiscard]] Localizer make(std::uint64_t seed = 1,
                               const UnknownPlaceParams& unknown_place = {.max_contact = 0.0}) {
    LocalizerConfig config = follow(script_);
    config.unknown_place = unknown_place;
    return {config, catalog_, {map_of_one_point(), 1}, seed};
  }

  /// The matcher's answer from now on.
  void give(const std::vector<Hypothesis>& hypotheses, const std::vector<double>& r) {
    script_->match = [=](double, Rng&) { return MatchResult{hypotheses, 70, 900}; };
    script_->r = r;
  }

  /// First random numbers that matcher and clusterer of each step get.
  std::vector<std::uint64_t> draws(Localizer& localizer, int steps) {
    std::vector<std::uint64_t> numbers;
    script_->match = [&](double, Rng& rng) {
      numbers.push_back(rng.next());
      return MatchResult{};
    };
    script_->cluster = [&](Rng& rng) { numbers.push_back(rng.next()); };
    for (int i = 0; i < steps; ++i) static_cast<void>(localizer.step({}));
    return numbers;
  }

  std::shared_ptr<Script> script_ = std::make_shared<Script>();
  Catalog catalog_;
};

TEST_F(LocalizerTest, CallsTheStagesInTheOrderOfThePaper) {
  Localizer localizer = make();
  static_cast<void>(localizer.step({}));
  EXPECT_THAT(script_->calls, ElementsAre("add", "omega_max", "match", "update", "cluster", "rate", "judge"));
}

TEST_F(LocalizerTest, TheThresholdOfAStepIsTheOneBeforeItsUpdate) {
  std::vector<double> passed;
  script_->match = [&](double omega_max, Rng&) {
    passed.push_back(omega_max);
    return MatchResult{};
  };
  script_->updated_omega_max = 0.7;
  Localizer localizer = make();
  EXPECT_EQ(localizer.step({}).omega_max, 0.3);
  EXPECT_EQ(localizer.step({}).omega_max, 0.7);
  EXPECT_THAT(passed, ElementsAre(0.3, 0.7));
}

TEST_F(LocalizerTest, AnotherThresholdPolicyTakesThePlaceOfTheConfiguredOne) {
  struct Half final : ThresholdPolicy {
    [[nodiscard]] double omega_max() const override { return 0.5; }
    void update(const std::vector<Hypothesis>& /*hypotheses*/) override {}
    void reset() override {}
  };
  Localizer localizer = make();
  localizer.use(std::make_unique<Half>());
  EXPECT_EQ(localizer.step({}).omega_max, 0.5);
  localizer.reset(1);
  EXPECT_EQ(localizer.step({}).omega_max, 0.5);
  EXPECT_THAT(script_->calls, Not(testing::Contains("omega_max")));
}

TEST_F(LocalizerTest, ClustersFollowTheirRatingsDownwardsAndEqualOnesKeepTheirOrder) {
  give({Hypothesis::by_contact(Pose2{1, 0, 0}, 0.9), Hypothesis::by_contact(Pose2{2, 0, 0}, 0.8),
        Hypothesis::by_contact(Pose2{3, 0, 0}, 0.7), Hypothesis::by_contact(Pose2{4, 0, 0}, 0.6)},
       {0.2, 0.5, 0.2, 0.9});
  std::vector<double> judged;
  script_->judge = [&](const StepResult& step) {
    for (const Rating& rating : step.ratings) judged.push_back(rating.r);
    return Verdict{};
  };
  Localizer localizer = make();
  const StepResult result = localizer.step({});
  std::vector<double> order;
  for (const Cluster& cluster : result.clusters) order.push_back(cluster.map_from_robot.x);
  EXPECT_THAT(order, ElementsAre(4, 2, 1, 3));
  EXPECT_THAT(judged, ElementsAre(0.9, 0.5, 0.2, 0.2));
  EXPECT_EQ(result.estimate(), (Pose2{4, 0, 0}));
}

TEST_F(LocalizerTest, ReportsWhatTheStagesFound) {
  script_->local.points.push_back({});
  script_->local.points.push_back({});
  script_->local.ends = {2};
  script_->local.local_from_robot = Pose2{1, 2, 0.5};
  script_->local.epoch = 3;
  give({{.map_from_local = {}, .quality = 0.9, .score = 0.7}, Hypothesis::by_contact(Pose2{2, 0, 0}, 0.4)},
       {0.5, 0.6});
  script_->judge = [](const StepResult&) {
    return Verdict{VerdictKind::ambiguous, std::nullopt, {Pose2{2, 0, 0}, Pose2{1, 0, 0}}, "two"};
  };
  Localizer localizer = make();
  Scan scan;
  scan.hits = moved(script_->local.points, inverse(script_->local.local_from_robot));
  const StepResult result = localizer.step({12.5, scan, {}});
  EXPECT_EQ(result.stamp, 12.5);
  EXPECT_EQ(result.local_from_robot, (Pose2{1, 2, 0.5}));
  EXPECT_EQ(result.local_map_epoch, 3);
  EXPECT_EQ(result.local_map_points, 2U);
  EXPECT_EQ(result.omega_best, 0.9);
  EXPECT_EQ(result.score_best, 0.7);
  EXPECT_EQ(result.omega_place, 1.0);
  EXPECT_EQ(result.proposals, 70U);
  EXPECT_EQ(result.points_tested, 900U);
  EXPECT_EQ(result.hypotheses.size(), 2U);
  EXPECT_EQ(result.verdict.kind, VerdictKind::ambiguous);
  EXPECT_THAT(result.verdict.candidates, ElementsAre(Pose2{2, 0, 0}, Pose2{1, 0, 0}));
}

TEST_F(LocalizerTest, TheRobotIsWhereAHypothesisPutsItsLocalMap) {
  script_->local.local_from_robot = Pose2{3, 0, 0};
  Hypothesis mistaken = Hypothesis::by_contact(Pose2{1, 2, radians(90.0)}, 0.9);
  mistaken.map_from_robot = Pose2{7, 7, 7};  // whatever a matcher says of it
  give({mistaken}, {0.5});
  Localizer localizer = make();
  const StepResult result = localizer.step({});
  ASSERT_EQ(result.hypotheses.size(), 1U);
  const Pose3& robot = result.hypotheses.front().map_from_robot;
  EXPECT_NEAR(robot.x, 1.0, 1e-12);
  EXPECT_NEAR(robot.y, 5.0, 1e-12);
  EXPECT_NEAR(robot.heading(), radians(90.0), 1e-12);
  EXPECT_EQ(result.clusters.front().map_from_robot, robot);
}

TEST_F(LocalizerTest, AStepWithoutHypothesesHasNoBest) {
  Localizer localizer = make();
  const StepResult result = localizer.step({});
  EXPECT_EQ(result.omega_best, 0.0);
  EXPECT_EQ(result.score_best, 0.0);
  EXPECT_EQ(result.omega_place, std::nullopt);
  EXPECT_EQ(result.omega_scan, std::nullopt);
  EXPECT_EQ(result.estimate(), std::nullopt);
}

TEST_F(LocalizerTest, AnUnknownPlaceOverridesTheVerdict) {
  // One of eight hits is on the map.
  Observation observation;
  for (int i = 0; i < 8; ++i) observation.scan.hits.push_back({static_cast<float>(i), 0.0F, 0.0F});
  give({Hypothesis::by_contact({}, 0.9)}, {0.5});
  script_->judge = [](const StepResult&) {
    return Verdict{VerdictKind::localized, Pose2{1, 0, 0}, {Pose2{1, 0, 0}}, "sure"};
  };
  Localizer wary = make(1, {.max_contact = 0.2});
  const StepResult unknown = wary.step(observation);
  EXPECT_EQ(unknown.omega_place, 0.125);
  EXPECT_EQ(unknown.verdict.kind, VerdictKind::unknown_place);
  EXPECT_EQ(unknown.verdict.map_from_robot, std::nullopt);
  EXPECT_TRUE(unknown.verdict.candidates.empty());
  EXPECT_EQ(unknown.verdict.why, "only 12 % of what was last seen is on the map");

  Localizer bold = make(1, {.max_contact = 0.1});
  const StepResult localized = bold.step(observation);
  EXPECT_EQ(localized.verdict.kind, VerdictKind::localized);
  EXPECT_EQ(localized.verdict.map_from_robot, (Pose2{1, 0, 0}));
}

TEST_F(LocalizerTest, ResetReachesAllStagesAndCountsFromZero) {
  script_->local.points.push_back({});
  script_->local.ends = {1};
  give({Hypothesis::by_contact({}, 0.9)}, {0.5});
  script_->updated_omega_max = 0.7;
  Localizer localizer = make();
  EXPECT_EQ(localizer.step({}).step, 0U);
  EXPECT_EQ(localizer.step({}).step, 1U);
  script_->calls.clear();
  localizer.reset(1);
  EXPECT_THAT(script_->calls, testing::UnorderedElementsAre("reset local map", "reset matcher",
                                                            "reset threshold", "reset verdict"));
  give({}, {});
  const StepResult first = localizer.step({});
  EXPECT_EQ(first.step, 0U);
  EXPECT_EQ(first.omega_max, 0.3);
  // The best hypothesis of the trial before is forgotten.
  EXPECT_EQ(first.omega_place, std::nullopt);
}

TEST_F(LocalizerTest, EveryStageStepTrialAndSeedHasRandomNumbersOfItsOwn) {
  Localizer localizer = make();
  std::vector<std::uint64_t> all;
  for (const std::uint64_t trial : {0U, 1U, 2U}) {
    localizer.reset(trial);
    const auto some = draws(localizer, 3);
    all.insert(all.end(), some.begin(), some.end());
  }
  Localizer other = make(2);
  const auto some = draws(other, 3);
  all.insert(all.end(), some.begin(), some.end());
  ASSERT_EQ(all.size(), 24U);
  std::sort(all.begin(), all.end());
  EXPECT_EQ(std::adjacent_find(all.begin(), all.end()), all.end());
}

TEST_F(LocalizerTest, ATrialDrawsTheSameNumbersWheneverItRuns) {
  Localizer localizer = make();
  const auto fresh = draws(localizer, 2);
  localizer.reset(5);
  const auto fifth = draws(localizer, 2);
  localizer.reset(0);
  EXPECT_EQ(draws(localizer, 2), fresh);
  EXPECT_THAT(fifth, Not(fresh));
  Localizer other = make();
  other.reset(5);
  EXPECT_EQ(draws(other, 2), fifth);
}

/// What a step fails with; empty if it does not.
std::string failure_of(Localizer& localizer) {
  return error_of<StrategyError>([&] { return localizer.step({}); });
}

TEST_F(LocalizerTest, NamesTheStrategyThatBreaksItsContract) {
  Localizer localizer = make();
  EXPECT_EQ(failure_of(localizer), "");
  give({Hypothesis::by_contact(Pose2{1, 0, 0}, 0.2)}, {1.0});
  EXPECT_EQ(
      failure_of(localizer),
      "matcher 'fake' breaks its contract in step 1: hypothesis 0 has the score 0.2, below omega_max = 0.3");
  give({Hypothesis::by_contact(Pose2{1, 0, 0}, 0.9)}, {2.0});
  EXPECT_EQ(failure_of(localizer),
            "rater 'fake' breaks its contract in step 2: rating 0 has r = 2, not in [0, 1]");
  give({}, {});
  script_->judge = [](const StepResult&) { return Verdict{VerdictKind::localized, {}, {}, "sure"}; };
  EXPECT_THAT(failure_of(localizer),
              testing::StartsWith("verdict_rule 'fake' breaks its contract in step 3: "));
  script_->local.ends = {1};
  EXPECT_THAT(failure_of(localizer),
              testing::StartsWith("local_mapper 'fake' breaks its contract in step 4: "));
  script_->local.ends = {};
  script_->omega_max = script_->updated_omega_max = 1.5;
  EXPECT_EQ(failure_of(localizer),
            "threshold_policy 'fake' breaks its contract in step 5: omega_max() is 1.5, not in [0, 1]");
}

TEST_F(LocalizerTest, NamesTheStrategyThatThrows) {
  Localizer localizer = make();
  script_->match = [](double, Rng&) -> MatchResult { throw std::out_of_range("no such cell"); };
  EXPECT_EQ(failure_of(localizer), "matcher 'fake' threw an exception in step 0: no such cell");
  script_->match = [](double, Rng&) -> MatchResult { throw 7; };  // NOLINT: no std::exception
  EXPECT_EQ(failure_of(localizer), "matcher 'fake' threw something that is no std::exception in step 1");
}

TEST_F(LocalizerTest, TakesNoObservationThatIsNoPlace) {
  Localizer localizer = make();
  Observation observation;
  observation.scan.hits.push_back({0.0F, std::numeric_limits<float>::infinity(), 0.0F});
  EXPECT_THROW(static_cast<void>(localizer.step(observation)), StrategyError);
}

TEST_F(LocalizerTest, KnowsWhichStageIsRunning) {
  std::string running;
  script_->match = [&](double, Rng&) {
    parallel_for(2, 2, [&](std::size_t i) {
      if (i == 1) running = running_stage()->kind + " " + running_stage()->name;
    });
    return MatchResult{};
  };
  Localizer localizer = make();
  EXPECT_EQ(running_stage(), nullptr);
  static_cast<void>(localizer.step({}));
  EXPECT_EQ(running, "matcher fake");
  EXPECT_EQ(running_stage(), nullptr);
}

/// Works in the plane, as it does not say otherwise.
struct PlanarRater final : Rater {
  struct Params {};
  explicit PlanarRater(const Params& /*params*/) {}
  [[nodiscard]] std::vector<Rating> rate(const std::vector<Cluster>& /*clusters*/,
                                         const std::vector<Hypothesis>& /*hypotheses*/) override {
    return {};
  }
};
void describe(ParamVisitor& /*v*/, PlanarRater::Params& /*p*/) {}

TEST_F(LocalizerTest, AStageThatCannotDoTheMotionIsRefused) {
  catalog_.raters.add<PlanarRater>("flat", "Does nothing.");
  LocalizerConfig config = follow(script_);
  config.rater = {"flat"};
  const auto make_with = [&](Motion motion) {
    config.motion = motion;
    const Localizer localizer(config, catalog_, {map_of_one_point(), 1}, 1);
  };
  EXPECT_NO_THROW(make_with(Motion::planar));
  EXPECT_EQ(error_of([&] { make_with(Motion::free); }),
            "error: the rater 'flat' can do the motion planar, not free; set localizer.motion to planar, or "
            "take fake");
}

TEST_F(LocalizerTest, PosesInSpaceGoAllTheWay) {
  const Pose3 map_from_local({1, 2, 3}, exponential({0.1, 0.2, 0.3}));
  script_->local.local_from_robot = Pose3({0.5, 0, -1}, exponential({-0.2, 0, 0.4}));
  give({Hypothesis::by_contact(map_from_local, 0.9)}, {1.0});
  LocalizerConfig config = follow(script_);
  config.motion = Motion::free;
  Localizer localizer(config, catalog_, {map_of_one_point(), 1}, 1);
  const StepResult result = localizer.step({});
  EXPECT_EQ(result.motion, Motion::free);
  EXPECT_EQ(result.hypotheses.front().map_from_robot, map_from_local * script_->local.local_from_robot);
  EXPECT_EQ(result.estimate(), result.hypotheses.front().map_from_robot);
  EXPECT_THROW(static_cast<void>(make().step({})), StrategyError) << "where the motion is planar";
}

class WithPrior : public LocalizerTest {
 protected:
  /// The map is its origin: the region must not be far from it.
  [[nodiscard]] Localizer make_with(const Prior& prior) {
    LocalizerConfig config = follow(script_);
    config.prior = prior;
    return {config, catalog_, {map_of_one_point(), 1}, 1};
  }

  static Prior around(double x, double y) { return {.region = {x, y, 1.0}, .heading = {}}; }

  /// Where the hypotheses of a step put the robot, by x.
  static std::vector<double> places(const StepResult& result) {
    std::vector<double> x;
    for (const Hypothesis& h : result.hypotheses) x.push_back(h.map_from_robot.x);
    return x;
  }
};

TEST_F(WithPrior, NothingOutsideOfItGoesOn) {
  give({Hypothesis::by_contact(Pose2{9, 0, 0}, 0.9), Hypothesis::by_contact(Pose2{3.5, 0, 0}, 0.8),
        Hypothesis::by_contact(Pose2{1.5, 0, 0}, 0.7), Hypothesis::by_contact(Pose2{2.5, 0, 0}, 0.6)},
       {0.5, 0.4});
  Localizer localizer = make_with(around(3, 0));
  const StepResult result = localizer.step({});
  EXPECT_THAT(places(result), ElementsAre(3.5, 2.5));
  EXPECT_EQ(result.clusters.size(), 2U);
  EXPECT_EQ(result.omega_best, 0.8);
  EXPECT_EQ(result.proposals, 70U);
}

TEST_F(WithPrior, TheMatcherIsToldWhatItAllows) {
  Localizer localizer = make_with(around(3, 0));
  static_cast<void>(localizer.step({}));
  EXPECT_THAT(script_->calls, ElementsAre("add", "omega_max", "match", "update", "cluster", "rate", "judge"));
  EXPECT_TRUE(script_->gate.allows(Pose2{3, 0.9, 2}));
  EXPECT_FALSE(script_->gate.allows(Pose2{3, 1.1, 2}));
}

TEST_F(WithPrior, ItIsAboutTheStartAndNotAboutWhereTheRobotIs) {
  give({Hypothesis::by_contact(Pose2{3, 0, 0}, 0.9), Hypothesis::by_contact(Pose2{13, 0, 0}, 0.9)}, {0.5});
  Localizer localizer = make_with(around(3, 0));
  static_cast<void>(localizer.step({}));
  script_->local.local_from_robot = Pose2{10, 0, 0};
  EXPECT_THAT(places(localizer.step({0.0, {}, Pose2{10, 0, 0}})), ElementsAre(13.0));

  // The local map begins anew 2 m farther on: the start is 12 m behind its origin.
  script_->local.local_from_robot = {};
  script_->local.epoch = 1;
  give({Hypothesis::by_contact(Pose2{3, 0, 0}, 0.9), Hypothesis::by_contact(Pose2{15, 0, 0}, 0.9)}, {0.5});
  EXPECT_THAT(places(localizer.step({0.0, {}, Pose2{12, 0, 0}})), ElementsAre(15.0));

  // Another trial has a start of its own.
  localizer.reset(1);
  EXPECT_THAT(places(localizer.step({0.0, {}, Pose2{12, 0, 0}})), ElementsAre(3.0));
}

TEST_F(WithPrior, EveryVerdictSaysWhatWasLookedAt) {
  const Prior prior{.region = {3.0, 4.0, 5.0}, .heading = {90.0, 40.0}};
  const std::string looked_at =
      "only starts within 5 m of x 3, y 4 with headings of 90 ± 20 deg were looked at";
  Localizer localizer = make_with(prior);
  EXPECT_EQ(localizer.step({}).verdict.why, looked_at);
  for (const VerdictKind kind : {VerdictKind::searching, VerdictKind::ambiguous, VerdictKind::localized}) {
    script_->judge = [&](const StepResult&) {
      Verdict verdict{kind, std::nullopt, {}, "as it is"};
      if (kind == VerdictKind::localized) verdict.map_from_robot = Pose2{3, 4, 1};
      if (kind == VerdictKind::ambiguous) verdict.candidates = {Pose2{3, 4, 1}, Pose2{2, 4, 1}};
      return verdict;
    };
    EXPECT_EQ(localizer.step({}).verdict.why, "as it is; " + looked_at);
  }
  script_->judge = [](const StepResult&) { return Verdict{VerdictKind::searching, {}, {}, "as it is"}; };
  EXPECT_EQ(make().step({}).verdict.why, "as it is");
}

TEST_F(WithPrior, InAnUnknownPlaceTheRobotIsPerhapsOutsideOfIt) {
  // One of eight hits is on the map.
  Observation observation;
  for (int i = 0; i < 8; ++i) observation.scan.hits.push_back({static_cast<float>(i), 0.0F, 0.0F});
  give({Hypothesis::by_contact({}, 0.9)}, {0.5});
  LocalizerConfig config = follow(script_);
  config.unknown_place = {.max_contact = 0.2};
  config.prior = around(0, 0.5);
  Localizer localizer(config, catalog_, {map_of_one_point(), 1}, 1);
  EXPECT_EQ(localizer.step(observation).verdict.why,
            "only 12 % of what was last seen is on the map; only starts within 1 m of x 0, y 0.5 were looked "
            "at: the robot is perhaps outside");
}

TEST_F(WithPrior, ARegionOffTheMapIsRefused) {
  EXPECT_NO_THROW(static_cast<void>(make_with(around(-90, 0))));
  EXPECT_THAT(error_of([&] { return make_with(around(300, 0)); }),
              testing::HasSubstr("localizer.prior.region: the map has nothing within 1 m of x 300"));
}

/// Writes down what it is made with.
class SetupWitness final : public Clusterer {
 public:
  struct Params {
    std::shared_ptr<StageSetup> seen;
  };
  SetupWitness(const Params& params, const StageSetup& setup) { *params.seen = setup; }
  [[nodiscard]] std::vector<Cluster> cluster(const std::vector<Hypothesis>& /*hypotheses*/,
                                             Rng& /*rng*/) override {
    return {};
  }
};
void describe(ParamVisitor& /*v*/, SetupWitness::Params& /*p*/) {}

TEST(ContactEpsilon, FollowsFromTheResolutionOfAMapOfPointsAlone) {
  const auto epsilon_on = [](double of_grid, double of_points) {
    MapData data;
    data.points.push_back({0.0F, 0.0F, 0.0F});
    data.grid.resolution = of_grid;
    data.resolution = of_points;
    return contact_epsilon_on(GlobalMap(std::move(data)), {});
  };
  EXPECT_DOUBLE_EQ(epsilon_on(0.0, 0.2), 0.4);
  EXPECT_DOUBLE_EQ(epsilon_on(0.03, 0.2), 0.06);
  EXPECT_DOUBLE_EQ(epsilon_on(0.0, 0.0), 0.1);
}

TEST_F(LocalizerTest, ContactEpsilonIsSaidOnceOrFollowsFromTheMap) {
  const auto seen = std::make_shared<StageSetup>();
  catalog_.clusterers.add<SetupWitness>("witness", "Writes down what it is made with.", {}, {seen});
  LocalizerConfig config = follow(script_);
  config.clusterer = catalog_.clusterers.choose("witness");
  const auto epsilon_on = [&](double resolution) {
    MapData data;
    data.points.push_back({0.0F, 0.0F, 0.0F});
    data.grid.resolution = resolution;
    const Localizer made(config, catalog_, {std::make_shared<const GlobalMap>(std::move(data)), 1}, 1);
    return seen->contact_epsilon;
  };
  EXPECT_DOUBLE_EQ(epsilon_on(0.05), 0.10);
  EXPECT_DOUBLE_EQ(epsilon_on(0.02), 0.04);
  EXPECT_DOUBLE_EQ(epsilon_on(0.0), 0.10);  // a map without a grid
  config.contact_epsilon = 0.25;
  EXPECT_DOUBLE_EQ(epsilon_on(0.05), 0.25);
}

TEST_F(LocalizerTest, StagesKnowWhetherThereIsAVerifier) {
  const auto seen = std::make_shared<StageSetup>();
  catalog_.clusterers.add<SetupWitness>("witness", "Writes down what it is made with.", {}, {seen});
  const auto is_known = [&](bool is_verified) {
    LocalizerConfig config = follow(script_, is_verified);
    config.clusterer = catalog_.clusterers.choose("witness");
    const Localizer made(config, catalog_, {std::make_shared<const GlobalMap>(MapData{}), 1}, 1);
    return seen->has_verifier;
  };
  EXPECT_FALSE(is_known(false));
  EXPECT_TRUE(is_known(true));
}

TEST_F(LocalizerTest, DeclaresNothingWhileTheSetUpIsWrong) {
  script_->judge = [](const StepResult&) {
    return Verdict{VerdictKind::localized, Pose2{1.0, 2.0, 0.0}, {}, "sure"};
  };
  LocalizerConfig config = follow(script_);
  config.setup_check.enabled = true;
  Localizer localizer(config, catalog_, {map_of_one_point(), 1}, 1);
  Observation observation;
  for (int i = 0; i < 20; ++i) observation.scan.hits.push_back({static_cast<float>(i), 1.0F, 0.0F});
  EXPECT_EQ(localizer.step(observation).verdict.kind, VerdictKind::localized);
  StepResult step;
  for (int i = 0; i < 3; ++i) {  // The same scan, and odometry goes on.
    observation.odom_from_robot.x += 0.3;
    step = localizer.step(observation);
    EXPECT_EQ(step.verdict.kind, VerdictKind::searching);
    EXPECT_EQ(step.verdict.map_from_robot, std::nullopt);
  }
  EXPECT_EQ(step.setup.value().fault, SetupFault::repeated_scans);
  EXPECT_THAT(step.verdict.why, testing::HasSubstr("the same scan"));
  localizer.reset(1);
  EXPECT_EQ(localizer.step(observation).verdict.kind, VerdictKind::localized);
}

/// Keeps what it is given.
struct KeepingMapper final : LocalMapper {
  struct Params {
    std::shared_ptr<Observation> kept;
  };
  static constexpr Motions motions = all_motions;
  explicit KeepingMapper(const Params& params) : kept(params.kept) {}
  void add(const Observation& observation) override { *kept = observation; }
  [[nodiscard]] const LocalMap& map() const override { return local; }
  void reset() override {}

  std::shared_ptr<Observation> kept;
  LocalMap local;
};
void describe(ParamVisitor& /*v*/, KeepingMapper::Params& /*p*/) {}

TEST_F(LocalizerTest, InThePlaneALaserMayBeMountedAboveTheMap) {
  const auto kept = std::make_shared<Observation>();
  catalog_.local_mappers.add<KeepingMapper>("keeping", "Keeps what it is given.", {}, {kept});
  LocalizerConfig config = follow(script_);
  config.local_mapper = catalog_.local_mappers.choose("keeping");
  Observation observation;
  observation.scan.hits.push_back({1.0F, 2.0F, 0.3F});
  observation.scan.free_ends.push_back({3.0F, 4.0F, 0.3F});
  observation.scan.origin = {0.1F, 0.0F, 0.3F};
  const auto after = [&](Motion motion) {
    config.motion = motion;
    static_cast<void>(Localizer(config, catalog_, {map_of_one_point(), 1}, 1).step(observation));
    return std::array{kept->scan.hits[0].z, kept->scan.free_ends[0].z, kept->scan.origin.z};
  };
  const float height = map_of_one_point()->points()[0].z;
  EXPECT_EQ(after(Motion::planar), (std::array{height, height, height}));
  EXPECT_EQ(after(Motion::free), (std::array{0.3F, 0.3F, 0.3F}));
}

/// A map of the point (500000, 4649776, 2000).
std::shared_ptr<const GlobalMap> far_map() {
  MapData data;
  data.points.push_back({});
  data.origin = {500'000.0, 4'649'776.0, 2000.0};
  return std::make_shared<const GlobalMap>(std::move(data));
}

class OnAFarMap : public LocalizerTest {
 protected:
  OnAFarMap() {
    give({Hypothesis::by_contact(Pose2{3, 4, 0.5}, 0.9), Hypothesis::by_contact(Pose2{-7, 1, 0}, 0.8)},
         {0.5, 0.4});
    script_->local.local_from_robot = Pose2{2, 0, 0};
  }
  [[nodiscard]] Localizer make_with(const LocalizerConfig& config) {
    return {config, catalog_, {far_map(), 1}, 1};
  }
};

TEST_F(OnAFarMap, StagesSeePosesRelativeToTheOriginAndResultsAreInTheMapsFrame) {
  std::optional<StepResult> seen;
  script_->judge = [&](const StepResult& step) {
    seen = step;
    Verdict verdict{VerdictKind::ambiguous, std::nullopt, {Pose2{3, 4, 0}, Pose2{1, -2, 0}}, "two"};
    verdict.estimate = {Pose2{3, 4, 0}, 0.5};
    return verdict;
  };
  const StepResult result = make_with(follow(script_)).step({});
  EXPECT_EQ(seen->hypotheses[1].map_from_robot, (Pose2{-5, 1, 0}));
  EXPECT_EQ(seen->clusters[1].map_from_robot, (Pose2{-5, 1, 0}));

  // In the plane nothing has a height.
  EXPECT_EQ(result.hypotheses[1].map_from_local, (Pose2{499'993, 4'649'777, 0}));
  EXPECT_EQ(result.hypotheses[1].map_from_robot, (Pose2{499'995, 4'649'777, 0}));
  EXPECT_EQ(result.hypotheses[0].map_from_local, (Pose2{500'003, 4'649'780, 0.5}));
  EXPECT_EQ(result.clusters[1].map_from_robot, (Pose2{499'995, 4'649'777, 0}));
  EXPECT_THAT(result.verdict.candidates,
              ElementsAre(Pose2{500'003, 4'649'780, 0}, Pose2{500'001, 4'649'774, 0}));
  EXPECT_EQ(result.estimate(), (Pose2{500'003, 4'649'780, 0}));
  EXPECT_EQ(result.local_from_robot, (Pose2{2, 0, 0}));
}

TEST_F(OnAFarMap, ADeclaredPoseAndItsRivalsAreInTheMapsFrame) {
  script_->local.points.push_back({});
  script_->judge = [](const StepResult&) {
    return Verdict{VerdictKind::localized, Pose2{5, 4, 0}, {}, "sure"};
  };
  script_->verify = [](const Pose3& map_from_local) {
    EXPECT_EQ(map_from_local, (Pose2{3, 4, 0}));
    Verification found;
    found.near = {.translation = 1.0, .rotation = 0.5};
    found.rivals = {Hypothesis::by_contact(Pose2{10, 20, 0}, 0.2)};
    found.certificate = {.contact = 0.9, .at_most = 0.2};
    return found;
  };
  const StepResult result = make_with(follow(script_, true)).step({});
  EXPECT_EQ(result.verdict.map_from_robot, (Pose2{500'005, 4'649'780, 0}));
  ASSERT_TRUE(result.verification);
  ASSERT_EQ(result.verification->rivals.size(), 1U);
  EXPECT_EQ(result.verification->rivals[0].map_from_local, (Pose2{500'010, 4'649'796, 0}));
  EXPECT_EQ(result.verification->rivals[0].map_from_robot, (Pose2{500'012, 4'649'796, 0}));
}

TEST_F(OnAFarMap, InSpaceHeightsAreOfTheMapsFrameToo) {
  give({Hypothesis::by_contact(Pose3({1, 2, 3}, exponential({0.1, 0.2, 0.3})), 0.9)}, {1.0});
  LocalizerConfig config = follow(script_);
  config.motion = Motion::free;
  const StepResult result = make_with(config).step({});
  EXPECT_EQ(result.hypotheses[0].map_from_local,
            Pose3({500'001, 4'649'778, 2003}, exponential({0.1, 0.2, 0.3})));
}

TEST_F(OnAFarMap, APriorIsInTheMapsFrame) {
  LocalizerConfig config = follow(script_);
  config.prior = {.region = {500'003.0, 4'649'780.0, 1.0}, .heading = {}};
  script_->r = {1.0};
  script_->local.local_from_robot = {};
  const StepResult result = make_with(config).step({});
  ASSERT_EQ(result.hypotheses.size(), 1U);
  EXPECT_EQ(result.hypotheses[0].map_from_robot, (Pose2{500'003, 4'649'780, 0.5}));
  EXPECT_EQ(result.verdict.why, "only starts within 1 m of x 500003, y 4649780 were looked at");
  config.prior.region.x = 3.0;
  EXPECT_THROW(static_cast<void>(make_with(config)), ConfigError);
}

/// A wall 4 m away, as a sensor with this noise sees it.
Observation noisy_wall(double deviation) {
  Rng rng(5);
  Observation observation;
  for (int i = -40; i <= 40; ++i) {
    const double angle = radians(i);
    const double range = 4.0 / std::cos(angle) + rng.normal(deviation);
    observation.scan.hits.push_back(
        {static_cast<float>(range * std::cos(angle)), static_cast<float>(range * std::sin(angle)), 0.0F});
  }
  return observation;
}

TEST_F(LocalizerTest, NoisyScansAreInContactFromFartherAway) {
  Localizer localizer = make();  // The map has no resolution: epsilon is 0.1 m.
  EXPECT_EQ(localizer.step(noisy_wall(0.03)).contact_epsilon, 0.1);
  script_->calls.clear();
  localizer.reset(1);
  script_->calls.clear();
  const StepResult noisy = localizer.step(noisy_wall(0.14));
  EXPECT_NEAR(noisy.range_noise.value_or(0.0), 0.14, 0.05);
  EXPECT_EQ(noisy.contact_epsilon, 0.2);
  EXPECT_THAT(script_->calls, ElementsAre("add", "reset matcher", "reset threshold", "reset verdict",
                                          "omega_max", "match", "update", "cluster", "rate", "judge"));
  EXPECT_THAT(script_->epsilons, ElementsAre(0.1, 0.2));
  // It stays so for the trial, and no longer.
  EXPECT_EQ(localizer.step({}).contact_epsilon, 0.2);
  localizer.reset(2);
  EXPECT_EQ(localizer.step({}).contact_epsilon, 0.1);
  static_cast<void>(localizer.step(noisy_wall(0.14)));
  EXPECT_EQ(script_->epsilons.size(), 2U);  // None is made twice.
}

TEST_F(LocalizerTest, AnEpsilonThatIsSaidStays) {
  LocalizerConfig config = follow(script_);
  config.contact_epsilon = 0.1;
  Localizer localizer(config, catalog_, {map_of_one_point(), 1}, 1);
  EXPECT_EQ(localizer.step(noisy_wall(0.14)).contact_epsilon, 0.1);
}

TEST_F(LocalizerTest, InSpaceNoNoiseIsTold) {
  LocalizerConfig config = follow(script_);
  config.motion = Motion::free;
  Localizer localizer(config, catalog_, {map_of_one_point(), 1}, 1);
  const StepResult result = localizer.step(noisy_wall(0.14));
  EXPECT_FALSE(result.range_noise);
  EXPECT_EQ(result.contact_epsilon, 0.1);
}

}  // namespace
}  // namespace glocal::test::localizer_test
