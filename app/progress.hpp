// How far a run is, for who is waiting for it.
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "evaluation/running/experiment_runner.hpp"
#include "report/live_run.hpp"

namespace glocal::app {

/// ", about 3 min left", once that can be told.
[[nodiscard]] std::string time_left(std::optional<double> left_s);

/// On a terminal one line that is written over again and again, elsewhere a line of the log now and then.
/// Calls may come from several threads.
class Progress {
 public:
  /// `trials` of all variants are to be run.
  Progress(bool shown, std::size_t trials);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// What is run from now on: a variant's name, or nothing.
  void begin(const std::string& what);
  /// `share` of the trial's observations are done.
  void step(std::size_t trial, std::size_t step, double share, const char* verdict);
  void finish(std::size_t trial);
  /// So many trials need not be run.
  void skip(std::size_t trials);

  /// How far it is.
  [[nodiscard]] RunProgress now();

 private:
  using Clock = std::chrono::steady_clock;

  [[nodiscard]] double share_done() const;
  [[nodiscard]] std::optional<double> seconds_left(double share_done) const;

  bool shown_;
  bool on_terminal_;
  double trials_;
  std::string what_;
  std::size_t finished_ = 0;
  std::map<std::size_t, double> running_;  ///< Shares of trials.
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_ = start_;
  std::mutex mutex_;
};

/// Tells whoever waits how far a run is: on the terminal, and to those who watch. Calls may come from several
/// threads.
class Waiting {
 public:
  explicit Waiting(bool quiet, LiveRun* live = nullptr) : quiet_(quiet), live_(live) {}

  /// Good as long as this object is.
  [[nodiscard]] RunnerCallbacks callbacks();

  /// Takes the bar off the terminal.
  void end() { progress_.reset(); }

 private:
  void begin(const LoadedVariant& variant);
  void step(std::size_t trial, const StepRecord& record, const Localizer& now);
  void finish(const TrialRecord& record);

  bool quiet_;
  LiveRun* live_;  ///< Null if nobody may watch.
  std::optional<Progress> progress_;
  std::size_t longest_trial_ = 1;  ///< Steps.
};

}  // namespace glocal::app
