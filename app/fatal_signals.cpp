#include "app/fatal_signals.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstring>
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
  void write() const { static_cast<void>(!::write(STDERR_FILENO, text_.data(), size_)); }

 private:
  std::array<char, 512> text_{};
  std::size_t size_ = 0;
};

std::string_view name_of(int signal) {
  switch (signal) {
    case SIGSEGV:
      return "SIGSEGV, memory that is not its own";
    case SIGBUS:
      return "SIGBUS, memory that cannot be read";
    case SIGFPE:
      return "SIGFPE, an impossible division";
    case SIGILL:
      return "SIGILL, no instruction of this processor";
    default:
      return "SIGABRT, it gave up";
  }
}

void say_where(int signal) {
  Line line;
  line.add("error: crashed (");
  line.add(name_of(signal));
  line.add(")");
  if (const RunningStage* stage = running_stage()) {
    line.add(" in ");
    line.add(stage->kind);
    line.add(" '");
    line.add(stage->name);
    line.add("'");
    if (stage->step != RunningStage::before_first) {
      line.add(", trial ");
      line.add(stage->trial);
      line.add(", step ");
      line.add(std::uint64_t{stage->step});
    }
  }
  line.add("; what was finished before is kept\n");
  line.write();
  raise(signal);
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
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) sigaction(signal, &action, nullptr);
}

}  // namespace glocal::app
