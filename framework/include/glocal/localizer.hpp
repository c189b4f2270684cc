// The paper's pipeline.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "glocal/catalog.hpp"
#include "glocal/motion.hpp"
#include "glocal/params.hpp"
#include "glocal/prior.hpp"
#include "glocal/running_stage.hpp"
#include "glocal/setup_check.hpp"
#include "glocal/unknown_place.hpp"

namespace glocal {

/// Which strategy does each stage. Defaults are the paper's method.
struct LocalizerConfig {
  Motion motion = Motion::planar;  ///< What of the robot's pose is looked for.
  /// m; epsilon of eq. 4 for all stages without one of their own. None: twice the map's resolution.
  std::optional<double> contact_epsilon = {};
  Prior prior = {};  ///< Outside of it nothing is looked for.
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
/// map's resolution.
[[nodiscard]] double contact_epsilon_on(const GlobalMap& map, const LocalizerConfig& config);

/// Finds out where a robot is, one observation after the other.
class Localizer {
 public:
  /// `seed` fixes all random numbers; motion and contact_epsilon of the setup are overruled by those of
  /// `config`; throws ConfigError where a strategy cannot work with this motion or this map, or the map has
  /// nothing where the prior is.
  Localizer(const LocalizerConfig& config, const Catalog& catalog, StageSetup setup, std::uint64_t seed);

  /// From now on this policy says which score is asked for, and not the configured one.
  void use(std::unique_ptr<ThresholdPolicy> threshold_policy);

  /// All poses of the result are in the map's frame, while stages see them relative to the map's origin.
  /// Throws StrategyError if a strategy throws an exception or breaks its contract (strategies.hpp); only
  /// reset() makes it good again.
  [[nodiscard]] StepResult step(const Observation& observation);

  /// Forgets everything; the steps that follow draw their random numbers from a stream of the trial's own.
  /// Throws StrategyError if a strategy throws an exception.
  void reset(std::uint64_t trial);

  /// The local map after the last step.
  [[nodiscard]] const LocalMap& local_map() const { return local_mapper_->map(); }
  [[nodiscard]] std::vector<MapFile> local_map_files() const { return local_mapper_->files(); }
  /// Which poses of the local map, relative to the map's origin, counted in the last step.
  [[nodiscard]] const PoseGate& gate() const { return gate_; }
  /// In which step of a trial a pose can be declared at the earliest, counted from 1.
  [[nodiscard]] std::size_t least_steps() const { return verdict_rule_->least_steps(); }
  /// What the matcher has made of the map.
  [[nodiscard]] std::optional<MapIndexInfo> map_index() const { return matcher_->map_index(); }

 private:
  /// Those of the strategies below.
  struct Stages {
    RunningStage local_mapper, matcher, clusterer, rater, threshold_policy, verdict_rule, verifier;
  };
  /// Does a strategy's work in this step, and checks it. What either throws becomes a StrategyError.
  template <class Work>
  void in_stage(RunningStage& stage, std::size_t step, Work work) const;

  // The stages of a step, in their order.
  const LocalMap& add(const Observation& observation, StepResult& result);
  void match(const LocalMap& local, const Observation& latest, StepResult& result);
  void cluster(StepResult& result);
  void rate(StepResult& result);
  void judge(StepResult& result);
  /// Takes back what the verdict rule declares where the set-up of the robot is wrong, or in doubt.
  void check_setup(const Observation& observation, const LocalMap& local, StepResult& result);
  /// Lets the verifier look for rivals of a pose when it is declared: with one, it is not.
  void verify(const LocalMap& local, StepResult& result);

  Motion motion_;
  Vector3 origin_;  ///< The map's; in the plane without a height.
  Prior prior_;     ///< In the map's frame.
  std::unique_ptr<LocalMapper> local_mapper_;
  std::unique_ptr<Matcher> matcher_;
  std::unique_ptr<Clusterer> clusterer_;
  std::unique_ptr<Rater> rater_;
  std::unique_ptr<ThresholdPolicy> threshold_policy_;
  std::unique_ptr<VerdictRule> verdict_rule_;
  std::unique_ptr<Verifier> verifier_;  ///< None where declarations stand as they are.
  Stages stages_;
  UnknownPlaceMonitor unknown_place_;
  std::optional<SetupMonitor> setup_;  ///< None where the set-up is not checked.
  StartInLocalMap start_;              ///< Followed where a prior is given.
  PoseGate gate_;
  bool is_verified_ = false;  ///< What is declared since some steps.
  Rng seed_;
  std::uint64_t trial_ = 0;
  Rng rng_;  ///< Of the trial.
  std::size_t step_ = 0;
};

}  // namespace glocal
