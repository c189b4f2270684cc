// The results of one run while its trials are running.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/results/journal.hpp"
#include "evaluation/results/output_folder.hpp"
#include "evaluation/results/summary.hpp"
#include "glocal/experiment.hpp"
#include "glocal/observation.hpp"

namespace glocal {

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
  void step(std::size_t trial, const StepRecord& record, const Scan& scan, const Localizer& localizer);
  /// Writes what the trial leaves; it need not be run again from here on, whatever happens.
  void finish(const TrialRecord& trial);

  /// Writes trials.jsonl and steps.jsonl, and sums up the trials that are finished.
  [[nodiscard]] Summary put_together();

 private:
  using MapFiles = std::vector<std::pair<std::string, std::string>>;  ///< Names and contents.

  void take_up(std::size_t trial, const std::function<void(const std::string&)>& warn);
  [[nodiscard]] bool keeps_map(std::size_t trial) const;
  MapFiles take_maps(std::size_t trial);

  OutputFolder& folder_;
  const OutputConfig& config_;
  std::size_t trials_;
  std::vector<std::size_t> to_run_;
  std::mutex mutex_;                      ///< For the maps.
  std::map<std::size_t, MapFiles> maps_;  ///< Of running trials.
};

}  // namespace glocal
