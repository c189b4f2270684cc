// The figures of a run.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <vector>

#include "evaluation/results/agreement.hpp"
#include "evaluation/running/trials.hpp"

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

  /// `run` says what does not follow from trials: `name`, `seed`, `map`, `peak_rss_mb` (of the process that
  /// ran them, or of the largest) and perhaps `others_load`. It is not complete if later trials are missing.
  [[nodiscard]] nlohmann::ordered_json to_json(const nlohmann::ordered_json& run, bool complete) const;
  /// What follows from the trials alone.
  [[nodiscard]] nlohmann::ordered_json figures() const;

 private:
  struct Values {
    std::vector<double> local_map, match, cluster, rate, verify, total, answer;
  };
  std::size_t count_ = 0, right_ = 0, wrong_ = 0, undecided_ = 0, declared_ = 0, failed_ = 0;
  std::vector<double> steps_, distances_m_;             ///< Of right trials.
  std::vector<double> translations_m_, rotations_deg_;  ///< Of right declarations.
  std::vector<double> later_translations_m_, later_rotations_deg_;
  std::vector<Declaration> declarations_;
  Values ms_;
};

}  // namespace glocal
