// The paper's pipeline.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "glocal/catalog.hpp"
#include "glocal/params.hpp"
#include "glocal/unknown_place.hpp"

namespace glocal {

/// Which strategy does each stage. Defaults are the paper's method.
struct LocalizerConfig {
  StrategyChoice local_mapper;
  StrategyChoice matcher;
  StrategyChoice clusterer;
  StrategyChoice rater;
  StrategyChoice threshold_policy;
  StrategyChoice verdict_rule;
  UnknownPlaceParams unknown_place;
};

/// Finds out where a robot is, one observation after the other.
class Localizer {
 public:
  /// `seed` fixes all random numbers; throws ConfigError where a strategy cannot work with this map.
  Localizer(const LocalizerConfig& config, const Catalog& catalog, const StageSetup& setup,
            std::uint64_t seed);

  [[nodiscard]] StepResult step(const Observation& observation);

  /// Forgets everything; the steps that follow draw their random numbers from a stream of the trial's own.
  void reset(std::uint64_t trial);

  /// The local map after the last step.
  [[nodiscard]] const LocalMap& local_map() const { return local_mapper_->map(); }
  [[nodiscard]] std::vector<MapFile> local_map_files() const { return local_mapper_->files(); }
  /// What the matcher has made of the map.
  [[nodiscard]] std::optional<MapIndexInfo> map_index() const { return matcher_->map_index(); }

 private:
  std::unique_ptr<LocalMapper> local_mapper_;
  std::unique_ptr<Matcher> matcher_;
  std::unique_ptr<Clusterer> clusterer_;
  std::unique_ptr<Rater> rater_;
  std::unique_ptr<ThresholdPolicy> threshold_policy_;
  std::unique_ptr<VerdictRule> verdict_rule_;
  UnknownPlaceMonitor unknown_place_;
  Rng seed_;
  Rng trial_;
  std::size_t step_ = 0;
};

}  // namespace glocal
