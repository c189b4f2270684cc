// The figures of a run.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/results/agreement.hpp"
#include "evaluation/running/trials.hpp"
#include "glocal/strategies.hpp"

namespace glocal {

/// What the figures of a run need of one trial.
struct TrialFigures {
  Outcome outcome = Outcome::undecided;
  double steps = 0.0;
  double distance_m = 0.0;
  PoseError error = {};                         ///< Of a right declaration.
  std::vector<StageTimes> step_ms = {};         ///< Of all steps.
  std::vector<PoseError> later_errors = {};     ///< Of the steps on the map that are localized.
  std::optional<Declaration> declaration = {};  ///< Of one that no reference can judge.
};
[[nodiscard]] TrialFigures figures_of(const TrialRecord& trial);

/// The most memory that this process has held so far.
[[nodiscard]] double peak_rss_mb();

/// Collects trials and sums them up as the contract for `summary.json` says.
class Summary {
 public:
  void add(const TrialFigures& trial);

  struct Run {
    std::string name;
    std::uint64_t seed = 0;
    bool complete = true;  ///< False if the run was interrupted: later trials are missing.
    std::size_t map_points = 0;
    double map_build_ms = 0.0;
    double map_index_ms = 0.0;  ///< To make all stages, which build what they look up in the map.
    std::optional<MapIndexInfo> map_index = {};
    double peak_rss_mb = 0.0;  ///< Of the process that ran the trials, or of the largest.
    /// Processors that others kept busy while trials ran, in the mean; none if not known.
    std::optional<double> others_load = {};
  };
  [[nodiscard]] nlohmann::ordered_json to_json(const Run& run) const;
  /// What follows from the trials alone.
  [[nodiscard]] nlohmann::ordered_json figures() const;

 private:
  struct Values {
    std::vector<double> local_map, match, cluster, rate, verify, total;
  };
  std::size_t count_ = 0, right_ = 0, wrong_ = 0, undecided_ = 0, declared_ = 0, failed_ = 0;
  std::vector<double> steps_, distances_m_;             ///< Of right trials.
  std::vector<double> translations_m_, rotations_deg_;  ///< Of right declarations.
  std::vector<double> later_translations_m_, later_rotations_deg_;
  std::vector<Declaration> declarations_;
  Values ms_;
};

}  // namespace glocal
