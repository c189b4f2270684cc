// Work in a process of its own: what ends it leaves this one alive.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "app/fatal_signals.hpp"

namespace glocal::app {

/// How a child has ended.
struct ChildEnd {
  std::optional<int> exit_code;  ///< None if something ended it before its work was over.
  std::string cause;             ///< That: "SIGSEGV", "SIGKILL, memory ran out", "exit(0)".
  /// What ended it came from within: a fault, too much memory, or a call of exit().
  bool is_own_fault = false;
  std::optional<CrashReport> crash;  ///< Its last word.
};

/// Runs `work` in a child, whose exit code is what it returns, or what exit_code_of() makes of an exception,
/// and waits for its end. Calls `now_and_then` twice a minute meanwhile. An interrupt of this process is
/// passed on; the child does not outlive this process. To be called while this process has no threads
/// besides its first. Throws RunError if there can be no child.
[[nodiscard]] ChildEnd run_in_child(
    const std::function<int()>& work, const std::function<void()>& now_and_then = [] {});

}  // namespace glocal::app
