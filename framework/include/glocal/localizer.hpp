// The paper's pipeline.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "glocal/catalog.hpp"
#include "glocal/motion.hpp"
#include "glocal/params.hpp"
#include "glocal/prior.hpp"
#include "glocal/range_noise.hpp"
#include "glocal/running_stage.hpp"
#include "glocal/setup_check.hpp"
#include "glocal/unknown_place.hpp"

namespace glocal {

/// Which strategy does each stage. Defaults are the paper's method.
struct LocalizerConfig {
  Motion motion = Motion::planar;  ///< What of the robot's pose is looked for.
  /// m; epsilon of eq. 4 for all stages without one of their own. None: twice the map's resolution, and more
  /// where scans are noisier than that.
  std::optional<double> contact_epsilon = {};
  int looks_per_step = 0;  ///< Of searches, at points; 0 is as many as they take.
  Prior prior = {};        ///< Outside of it nothing is looked for.
  StrategyChoice local_mapper;
  StrategyChoice matcher;
  StrategyChoice clusterer;
  StrategyChoice rater;
  StrategyChoice threshold_policy;
  StrategyChoice verdict_rule;
  StrategyChoice verifier;
  UnknownPlaceParams unknown_place;
  SetupCheckParams setup_check;
};

/// What a stage of the localizer must not be because of how the robot moves: a sentence with the motions that
/// the strategy can do, and what to do about it. None if it can do this one, or is not in the registry.
[[nodiscard]] std::optional<std::string> why_unfit(const StrategyChoice& choice, const RegistryBase& registry,
                                                   Motion motion);

/// The epsilon of eq. 4 (m) that the localizer's stages take on this map: as configured, or else twice the
/// map's resolution, before any scan was seen.
[[nodiscard]] double contact_epsilon_on(const GlobalMap& map, const LocalizerConfig& config);

/// Finds out where a robot is, one observation after the other.
class Localizer {
 public:
  /// `seed` fixes all random numbers; motion and contact_epsilon of the setup are overruled by those of
  /// `config`; throws ConfigError where a strategy cannot work with this motion or this map, or the map has
  /// nothing where the prior is. The catalog must live as long as the localizer.
  Localizer(const LocalizerConfig& config, const Catalog& catalog, StageSetup setup, std::uint64_t seed);

  /// From now on this policy says which score is asked for, and not the configured one.
  void use(std::unique_ptr<ThresholdPolicy> threshold_policy);

  /// All poses of the result are in the map's frame, while stages see them relative to the map's origin.
  /// Throws StrategyError if a strategy throws an exception or breaks its contract (strategies.hpp); only
  /// reset() makes it good again.
  [[nodiscard]] StepResult step(const Observation& observation);

  /// Goes on with the search that the last step or go_on() has left open (StepResult::goes_on), as a robot
  /// may until its next scan comes, by so many looks at points: without a number to its end. The result is
  /// that of the step, with what is known by now, and with the time that it took. Throws as step();
  /// std::logic_error where none is open.
  [[nodiscard]] StepResult go_on(std::size_t looks = std::numeric_limits<std::size_t>::max());

  /// Forgets everything; the steps that follow draw their random numbers from a stream of the trial's own.
  /// Throws StrategyError if a strategy throws an exception.
  void reset(std::uint64_t trial);

  /// Where the robot is thought to be in the next step, the first one after reset(): one more candidate,
  /// judged and verified like any other, and with odds of its own. It is dropped once another pose is better,
  /// or none fits. Matchers that do not rescore poses know nothing of it.
  void expect(const ExpectedPose& expected) { expected_ = expected; }

  /// The local map after the last step.
  [[nodiscard]] const LocalMap& local_map() const { return local_mapper_->map(); }
  [[nodiscard]] std::vector<MapFile> local_map_files() const { return local_mapper_->files(); }
  /// Which poses of the local map, relative to the map's origin, counted in the last step.
  [[nodiscard]] const PoseGate& gate() const { return gate_; }
  /// In which step of a trial a pose can be declared at the earliest, counted from 1.
  [[nodiscard]] std::size_t least_steps() const { return verdict_rule_->least_steps(); }
  /// What the matcher has made of the map.
  [[nodiscard]] std::optional<MapIndexInfo> map_index() const { return by_contact_->matcher->map_index(); }

 private:
  /// Those of the strategies below.
  struct Stages {
    RunningStage local_mapper, matcher, clusterer, rater, threshold_policy, verdict_rule, verifier;
  };
  /// What asks the map for contact, for one epsilon.
  struct ContactStages {
    std::unique_ptr<Verifier> verifier;  ///< None where declarations stand as they are.
    std::unique_ptr<Matcher> matcher;
    UnknownPlaceMonitor unknown_place;
  };
  /// Takes the stages for this epsilon (m), and makes them if there are none. They may remember poses.
  void use_epsilon(double epsilon);
  /// Lets all stages forget what they know of poses, but not the local map.
  void forget_poses(std::size_t step);
  template <class Strategy>
  [[nodiscard]] std::unique_ptr<Strategy> make(const Registry<Strategy, StageSetup>& registry,
                                               const StrategyChoice& choice, RunningStage& stage) const;
  /// Does a strategy's work in this step, and checks it. What either throws becomes a StrategyError.
  template <class Work>
  void in_stage(RunningStage& stage, std::size_t step, Work work) const;

  // The stages of a step, in their order.
  /// Takes in how noisy the scan is. Where epsilon is too small for it, what asks for contact begins anew.
  void follow_noise(const Scan& scan, StepResult& result);
  const LocalMap& add(const Observation& observation, StepResult& result);
  void match(const LocalMap& local, const Observation& latest, StepResult& result);
  void take_in(MatchResult match, StepResult& result) const;
  /// From the hypotheses to the verdict, and ended().
  [[nodiscard]] StepResult judged(const LocalMap& local, const Observation& latest, StepResult result,
                                  std::optional<std::size_t> looks_after = {});
  /// Follows the expected pose while it is the best one.
  void follow_expected(const LocalMap& local, StepResult& result);
  /// Puts it among the hypotheses of the first step that has points.
  void add_expected(const LocalMap& local, StepResult& result);
  void cluster(StepResult& result);
  void rate(StepResult& result);
  void judge(StepResult& result);
  /// Tells the rule that what it declares is not told.
  void withhold(const StepResult& result);
  /// Takes back what the verdict rule declares where the set-up of the robot is wrong, or in doubt.
  void check_setup(const Observation& observation, const LocalMap& local, StepResult& result);
  /// Lets the verifier look for rivals of a pose when it is declared: with one, it is not.
  /// After the step has answered it goes on by so many looks.
  void verify(const LocalMap& local, StepResult& result, std::optional<std::size_t> looks_after);
  /// Verifies, and says what is to be said of any step.
  [[nodiscard]] StepResult ended(const LocalMap& local, StepResult result,
                                 std::optional<std::size_t> looks_after);
  /// One that goes on: what it is about is not declared.
  void forget_verification(std::size_t step);

  LocalizerConfig config_;
  const Catalog& catalog_;
  StageSetup stage_setup_;  ///< With the epsilon in use.
  Motion motion_;
  Vector3 origin_;                ///< The map's; in the plane without a height.
  std::optional<float> flat_at_;  ///< In the plane, if all points of the map have one height: that.
  std::unique_ptr<LocalMapper> local_mapper_;
  std::unique_ptr<Clusterer> clusterer_;
  std::unique_ptr<Rater> rater_;
  std::unique_ptr<ThresholdPolicy> threshold_policy_;
  std::unique_ptr<VerdictRule> verdict_rule_;
  Stages stages_;
  std::map<double, ContactStages> by_epsilon_;  ///< As many as were needed so far.
  ContactStages* by_contact_;                   ///< That of them which is in use.
  RangeNoise noise_;
  std::optional<SetupMonitor> setup_;  ///< None where the set-up is not checked.
  StartInLocalMap start_;              ///< Followed where a prior is given.
  PoseGate gate_;
  std::optional<ExpectedPose> expected_;  ///< In the map's frame; none once it was dropped.
  Pose3 expected_map_from_local_;         ///< Relative to the map's origin, after the first step.
  int expected_epoch_ = 0;                ///< Of that local map.
  bool is_expected_scored_ = false;       ///< The local map has had points.
  /// What was declared by the last step, once it is verified. Another pose that is declared is to be verified
  /// in turn.
  struct VerifiedPose {
    Pose3 map_from_local;
    int epoch;
    PoseTolerance near;
  };
  std::optional<VerifiedPose> verified_;
  bool is_verifying_ = false;       ///< A verification goes on.
  std::optional<StepResult> open_;  ///< The last step as far as it has come, where a search goes on.
  Observation open_observation_;    ///< Its observation.
  Rng seed_;
  std::uint64_t trial_ = 0;
  Rng rng_;  ///< Of the trial.
  std::size_t step_ = 0;
};

}  // namespace glocal
