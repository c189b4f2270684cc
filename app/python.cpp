#include "app/python.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>
#include <utility>

#include "glocal/error.hpp"

namespace glocal::app {
namespace {

/// Where a program's output goes.
class Output {
 public:
  explicit Output(bool is_dropped) {
    posix_spawn_file_actions_init(&actions_);
    if (!is_dropped) return;
    for (const int stream : {STDOUT_FILENO, STDERR_FILENO})
      posix_spawn_file_actions_addopen(&actions_, stream, "/dev/null", O_WRONLY, 0);
  }
  ~Output() { posix_spawn_file_actions_destroy(&actions_); }
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  [[nodiscard]] const posix_spawn_file_actions_t* actions() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

struct Ended {
  int exit_code = 0;
  int error = 0;  ///< Why it could not be started; 0 if it was.
};

Ended run(std::vector<std::string> words, const Output& output) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  if (const int error =
          posix_spawnp(&child, arguments[0], output.actions(), nullptr, arguments.data(), environ))
    return {.error = error};
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) return {.error = errno};
  }
  return {.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status)};
}

/// Why a Python is of no use here; none if it is.
std::optional<std::string> why_useless(const std::string& python) {
  const Ended ended = run({python, "-c", "import matplotlib"}, Output(true));
  if (ended.error != 0) return std::strerror(ended.error);
  if (ended.exit_code != 0) return "cannot import matplotlib";
  return std::nullopt;
}

}  // namespace

std::string python_with_matplotlib(const std::string& named) {
  std::vector<std::string> candidates = {named};
  if (named.empty()) candidates = {"python3", "/usr/bin/python3"};
  std::string tried;
  for (const std::string& python : candidates) {
    const auto why = why_useless(python);
    if (!why) return python;
    tried += fmt::format("{}{}: {}", tried.empty() ? "" : "; ", python, *why);
  }
  throw RunError(
      fmt::format("figures are drawn by Python with matplotlib ({}); install Debian's package "
                  "python3-matplotlib, or name another Python with --python",
                  tried));
}

int run_program(std::vector<std::string> words) {
  const std::string name = words.front();
  const Ended ended = run(std::move(words), Output(false));
  if (ended.error != 0)
    throw RunError(fmt::format("{}: cannot be run: {}", name, std::strerror(ended.error)));
  return ended.exit_code;
}

}  // namespace glocal::app
