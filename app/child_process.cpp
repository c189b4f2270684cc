#include "app/child_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "app/command_line.hpp"
#include "app/interrupts.hpp"
#include "glocal/error.hpp"

namespace glocal::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds between_calls{30};

/// How many processes the system has ended since it was started, to get memory back.
long killed_for_memory() {
  std::ifstream file("/proc/vmstat");
  std::string name;
  for (long value = 0; file >> name >> value;) {
    if (name == "oom_kill") return value;
  }
  return 0;
}

/// What a child says when its work is over: others may call exit() before.
constexpr char over = '.';

[[noreturn]] void be_child(const std::function<int()>& work, pid_t parent, int tell) {
  listen_to_parent();
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) std::_Exit(0);
  report_crashes_to(tell);
  const int code = exit_code_of(work);
  std::fflush(nullptr);
  static_cast<void>(!write(tell, &over, 1));
  // Without destructors: what this process has was made for the parent, too.
  std::_Exit(code);
}

ChildEnd end_of(int status, const std::string& said, bool out_of_memory) {
  ChildEnd end;
  if (WIFEXITED(status)) {
    if (said == std::string(1, over)) {
      end.exit_code = WEXITSTATUS(status);
    } else {
      end.cause = fmt::format("exit({})", WEXITSTATUS(status));
      end.is_own_fault = true;
    }
    return end;
  }
  end.cause = signal_name(WTERMSIG(status)) + (out_of_memory ? ", memory ran out" : "");
  end.is_own_fault = is_fault(WTERMSIG(status)) || out_of_memory;
  end.crash = crash_report_of(said);
  return end;
}

/// Waits until the child has ended; it says nothing but its last word.
std::string wait_for(pid_t child, int listen, const std::function<void()>& now_and_then) {
  std::string said;
  for (Clock::time_point called = Clock::now();;) {
    constexpr int ms = 200;
    pollfd input{listen, POLLIN, 0};
    if (poll(&input, 1, ms) > 0) {
      std::array<char, 1024> text{};
      const ssize_t n = read(listen, text.data(), text.size());
      if (n == 0) return said;
      if (n > 0) said.append(text.data(), static_cast<std::size_t>(n));
    }
    // Again and again: it may not have listened yet.
    if (is_interrupted()) interrupt_child(child);
    if (Clock::now() - called > between_calls) {
      now_and_then();
      called = Clock::now();
    }
  }
}

}  // namespace

ChildEnd run_in_child(const std::function<int()>& work, const std::function<void()>& now_and_then) {
  std::array<int, 2> pipe_ends{};
  const auto fail = [] {
    throw RunError(fmt::format("cannot start a process: {}", std::generic_category().message(errno)));
  };
  if (pipe2(pipe_ends.data(), O_CLOEXEC) != 0) fail();
  const auto [listen, tell] = pipe_ends;
  const long killed_before = killed_for_memory();
  std::fflush(nullptr);
  const pid_t parent = getpid();
  // Until it listens, the child is not to be ended by what its parent tells it.
  std::signal(SIGUSR1, SIG_IGN);
  const pid_t child = fork();
  if (child < 0) fail();
  if (child == 0) {
    close(listen);
    be_child(work, parent, tell);
  }
  close(tell);
  const std::string said = wait_for(child, listen, now_and_then);
  close(listen);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  const bool is_killed = WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL;
  return end_of(status, said, is_killed && killed_for_memory() > killed_before);
}

}  // namespace glocal::app
