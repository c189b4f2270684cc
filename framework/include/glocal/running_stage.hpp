// Which strategy a thread works for: for exceptions, and for whoever must say so when the program crashes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace glocal {

/// A stage with the strategy that does it, and when.
struct RunningStage {
  std::string kind;  ///< "matcher"
  std::string name;  ///< "ransam"
  std::uint64_t trial = 0;
  std::size_t step = before_first;

  /// Instead of a step: while the strategy is made or reset.
  static constexpr std::size_t before_first = static_cast<std::size_t>(-1);
};

/// That of this thread; null if it works for none. Safe to call in a signal handler.
[[nodiscard]] const RunningStage* running_stage();

/// Ends this process if it is a copy that a stage has made since it began: it has one thread only, and would
/// wait for the others.
void end_copies_of_stage();

/// The process in which it was made. A strategy that calls fork() and lets the copy return would have it run
/// the same trials and write to the same files, again and again.
class ProcessMark {
 public:
  ProcessMark();
  /// Ends a copy of that process at once, with a line on stderr that names the stage of this thread.
  void end_copies() const;

 private:
  int copies_;  ///< From the first process on.
};

/// As long as it lives, this thread works for a stage. A copy of the process that leaves it is ended.
class StageScope {
 public:
  /// Of `stage`, which must live longer, or of none if null.
  explicit StageScope(const RunningStage* stage);
  ~StageScope();
  StageScope(const StageScope&) = delete;
  StageScope& operator=(const StageScope&) = delete;

  [[nodiscard]] const RunningStage* stage() const { return stage_; }
  void end_copies() const { process_.end_copies(); }

 private:
  const RunningStage* stage_;
  const StageScope* before_;
  ProcessMark process_;
};

}  // namespace glocal
