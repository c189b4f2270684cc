// The files of a results folder, as text: docs/file-formats.md says what is in them.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "evaluation/running/trials.hpp"
#include "glocal/experiment.hpp"

namespace glocal {

/// What a line of steps.jsonl has, with so many clusters at most.
[[nodiscard]] nlohmann::ordered_json step_json(std::size_t trial, const StepRecord& step, int most_clusters);

/// One line of steps.jsonl.
[[nodiscard]] std::string step_line(std::size_t trial, const StepRecord& step,
                                    int most_clusters = OutputConfig{}.clusters);

/// Where a trial starts, as a line of trials.jsonl has it.
[[nodiscard]] nlohmann::ordered_json start_json(const TrialRecord& trial);

/// One line of trials.jsonl.
[[nodiscard]] std::string trial_line(const TrialRecord& trial);

/// The line of a trial that has not come to an end in any process; `start` is as start_json() gives it.
[[nodiscard]] std::string failed_trial_line(std::size_t trial, const nlohmann::ordered_json& start,
                                            const std::string& why);

/// A trajectory as evo reads it: stamp x y z qx qy qz qw on each line. Steps without a pose are left out.
struct Trajectories {
  std::string estimate;   ///< What was thought best in each step, declared or not.
  std::string localized;  ///< Declared poses: of steps with the verdict localized.
  std::string reference;
};
[[nodiscard]] Trajectories tum_trajectories(const TrialRecord& trial);

}  // namespace glocal
