// The results of one run while its trials are running.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/results/journal.hpp"
#include "evaluation/results/output_folder.hpp"
#include "evaluation/results/summary.hpp"
#include "evaluation/results/trial_output.hpp"
#include "glocal/experiment.hpp"

namespace glocal {

/// Writes trials.jsonl and, if asked, steps.jsonl of a run with so many trials, and sums them up. `entry_of`
/// gives the entry of a trial; none if the trial is missing. Files of trials are not touched.
[[nodiscard]] Summary put_together(
    OutputFolder& folder, bool has_steps, std::size_t trials,
    const std::function<std::optional<JournalEntry>(std::size_t trial)>& entry_of);

/// Keeps what trials leave, from any number of threads, and puts it together in the order of trials. Trials
/// that are in the folder's journal count as finished.
class RunResults {
 public:
  /// Drops what is damaged in the journal, and hands `warn` a sentence on it.
  RunResults(OutputFolder& folder, const OutputConfig& config, std::size_t trials,
             const std::function<void(const std::string&)>& warn);

  /// Numbers of the trials that are still to be run, ascending.
  [[nodiscard]] const std::vector<std::size_t>& to_run() const { return to_run_; }

  /// To be called after each step of a trial, with what the robot has seen in it.
  void step(std::size_t trial, const StepRecord& record, const Scan& scan, const Localizer& localizer) {
    collector_.step(trial, record, scan, localizer);
  }
  /// Writes what the trial leaves; it need not be run again from here on, whatever happens.
  void finish(const TrialRecord& trial);

  /// Writes trials.jsonl and steps.jsonl, and sums up the trials that are finished.
  [[nodiscard]] Summary put_together();

 private:
  void take_up(std::size_t trial, const std::function<void(const std::string&)>& warn);

  OutputFolder& folder_;
  const OutputConfig& config_;
  std::size_t trials_;
  std::vector<std::size_t> to_run_;
  TrialCollector collector_;
};

}  // namespace glocal
