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

/// As long as it lives, this thread works for a stage.
class StageScope {
 public:
  /// Of `stage`, which must live longer, or of none if null.
  explicit StageScope(const RunningStage* stage);
  ~StageScope();
  StageScope(const StageScope&) = delete;
  StageScope& operator=(const StageScope&) = delete;

 private:
  const RunningStage* before_;
};

}  // namespace glocal
