// What a trial leaves once it is over, before it is written anywhere.
#pragma once

#include <cstddef>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/results/journal_entry.hpp"
#include "glocal/experiment.hpp"
#include "glocal/observation.hpp"

namespace glocal {

/// Names, relative to the results folder, and contents.
using NamedContents = std::vector<std::pair<std::string, std::string>>;

struct TrialOutput {
  JournalEntry entry;
  NamedContents files;
};

/// Collects what running trials leave, from any number of threads.
class TrialCollector {
 public:
  explicit TrialCollector(const OutputConfig& config) : config_(config) {}

  /// To be called after each step of a trial, with what the robot has seen in it.
  void step(std::size_t trial, const StepRecord& record, const Scan& scan, const Localizer& localizer);
  [[nodiscard]] TrialOutput finish(const TrialRecord& trial);

  /// Whether the local maps of a trial are kept, and what it has seen of changes.
  [[nodiscard]] bool keeps_map(std::size_t trial) const;

 private:
  const OutputConfig& config_;
  std::mutex mutex_;                           ///< For the maps.
  std::map<std::size_t, NamedContents> maps_;  ///< Of running trials.
};

}  // namespace glocal
