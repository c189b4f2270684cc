// A last word when the program crashes: plugins are native code, and may do anything.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace glocal::app {

/// From now on a crash says in one line on stderr which signal it was and which strategy was at work; then
/// the program ends by that signal, as it would have without.
void name_strategy_in_crashes();

/// What is said of a crash to a process that watches this one.
struct CrashReport {
  std::uint64_t trial = 0;  ///< As localizers know it: the number of its start.
  std::string where;        ///< "matcher 'ransam', step 3"
};

/// From now on a crash in a strategy is also reported through this file descriptor.
void report_crashes_to(int descriptor);

/// What was written there; none if it is no report.
[[nodiscard]] std::optional<CrashReport> crash_report_of(const std::string& text);

/// "SIGSEGV" for 11.
[[nodiscard]] std::string signal_name(int signal);

/// Whether a process that ends by this signal has made a fault of its own.
[[nodiscard]] bool is_fault(int signal);

}  // namespace glocal::app
