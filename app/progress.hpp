// How far a run is, for who is waiting for it.
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "report/run_progress.hpp"

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

}  // namespace glocal::app
