#include "app/fatal_signals.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <string_view>

#include "glocal/running_stage.hpp"

namespace glocal::app {
namespace {

/// Sanitizers say more of a crash.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool is_sanitized = true;
#else
constexpr bool is_sanitized = false;
#endif

/// A line put together without any memory of its own: all that a signal handler may do.
class Line {
 public:
  void add(std::string_view text) {
    const std::size_t n = std::min(text.size(), text_.size() - size_);
    std::memcpy(text_.data() + size_, text.data(), n);
    size_ += n;
  }
  void add(std::uint64_t number) {
    std::array<char, 20> digits{};
    std::size_t first = digits.size();
    do {
      digits[--first] = static_cast<char>('0' + number % 10);
      number /= 10;
    } while (number > 0);
    add({digits.data() + first, digits.size() - first});
  }
  void write_to(int descriptor) const { static_cast<void>(!::write(descriptor, text_.data(), size_)); }

 private:
  std::array<char, 512> text_{};
  std::size_t size_ = 0;
};

/// What crashes are reported through; -1 if nobody wants to know.
std::atomic<int> watcher = -1;
static_assert(std::atomic<int>::is_always_lock_free, "read by a signal handler");

struct FatalSignal {
  int number;
  std::string_view name, meaning;
};
constexpr std::array<FatalSignal, 5> fatal_signals = {{{SIGSEGV, "SIGSEGV", "memory that is not its own"},
                                                       {SIGBUS, "SIGBUS", "memory that cannot be read"},
                                                       {SIGFPE, "SIGFPE", "an impossible division"},
                                                       {SIGILL, "SIGILL", "no instruction of this processor"},
                                                       {SIGABRT, "SIGABRT", "it gave up"}}};

const FatalSignal& fatal_signal(int number) {
  for (const FatalSignal& signal : fatal_signals) {
    if (signal.number == number) return signal;
  }
  return fatal_signals.back();
}

void add_strategy(Line& line, const RunningStage& stage) {
  line.add(stage.kind);
  line.add(" '");
  line.add(stage.name);
  line.add("'");
}

/// A line with the trial, and one with the place, as crash_report_of() reads them.
void tell_watcher(const RunningStage& stage, int descriptor) {
  Line line;
  line.add(stage.trial);
  line.add("\n");
  add_strategy(line, stage);
  if (stage.step != RunningStage::before_first) {
    line.add(", step ");
    line.add(std::uint64_t{stage.step});
  }
  line.write_to(descriptor);
}

void say_where(int number) {
  const FatalSignal& signal = fatal_signal(number);
  const RunningStage* stage = running_stage();
  Line line;
  line.add("error: crashed (");
  line.add(signal.name);
  line.add(", ");
  line.add(signal.meaning);
  line.add(")");
  if (stage != nullptr) {
    line.add(" in ");
    add_strategy(line, *stage);
    if (stage->step != RunningStage::before_first) {
      line.add(", trial ");
      line.add(stage->trial);
      line.add(", step ");
      line.add(std::uint64_t{stage->step});
    }
  }
  line.add("; what was finished before is kept\n");
  line.write_to(STDERR_FILENO);
  if (const int descriptor = watcher; descriptor >= 0 && stage != nullptr) tell_watcher(*stage, descriptor);
  raise(number);
}

}  // namespace

void name_strategy_in_crashes() {
  if (is_sanitized) return;
  // A stack of its own: a stack that has overflowed has no room.
  static std::array<char, 65'536> stack;
  stack_t alternative{};
  alternative.ss_sp = stack.data();
  alternative.ss_size = stack.size();
  sigaltstack(&alternative, nullptr);
  struct sigaction action {};
  action.sa_handler = say_where;
  action.sa_flags = static_cast<int>(SA_ONSTACK | SA_RESETHAND | SA_NODEFER);
  for (const FatalSignal& signal : fatal_signals) sigaction(signal.number, &action, nullptr);
}

void report_crashes_to(int descriptor) {
  watcher = descriptor;
}

std::optional<CrashReport> crash_report_of(const std::string& text) {
  std::istringstream lines(text);
  CrashReport report;
  if (!(lines >> report.trial)) return std::nullopt;
  std::getline(lines >> std::ws, report.where);
  return report;
}

std::string signal_name(int signal) {
  const char* const name = sigabbrev_np(signal);
  return name == nullptr ? "signal " + std::to_string(signal) : std::string("SIG") + name;
}

bool is_fault(int signal) {
  return std::any_of(fatal_signals.begin(), fatal_signals.end(),
                     [&](const FatalSignal& fatal) { return fatal.number == signal; });
}

}  // namespace glocal::app
