#include "app/programs.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "glocal/error.hpp"

namespace glocal::app {
namespace {

/// Which of a program's streams go to files.
class Redirections {
 public:
  Redirections() { posix_spawn_file_actions_init(&actions_); }
  ~Redirections() { posix_spawn_file_actions_destroy(&actions_); }
  Redirections(const Redirections&) = delete;
  Redirections& operator=(const Redirections&) = delete;

  void add(int stream, int file) { posix_spawn_file_actions_adddup2(&actions_, file, stream); }
  [[nodiscard]] const posix_spawn_file_actions_t* actions() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

/// Where a program's words are kept: a file without a name, which cannot fill up as a pipe does.
class Words {
 public:
  Words() : file_(std::tmpfile(), std::fclose) {
    if (!file_) throw RunError(fmt::format("cannot make a temporary file: {}", std::strerror(errno)));
  }

  [[nodiscard]] int descriptor() const { return ::fileno(file_.get()); }
  [[nodiscard]] std::string read() const {
    std::rewind(file_.get());
    std::string text;
    std::array<char, 4096> part{};
    while (const std::size_t n = std::fread(part.data(), 1, part.size(), file_.get()))
      text.append(part.data(), n);
    return text;
  }

 private:
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

Ended run(std::vector<std::string> words, const Redirections& redirections) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  if (const int error =
          posix_spawnp(&child, arguments[0], redirections.actions(), nullptr, arguments.data(), environ))
    return {.error = error};
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) return {.error = errno};
  }
  return {.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status)};
}

}  // namespace

Ended ask_program(const std::vector<std::string>& words) {
  const Words out;
  const Words err;
  Redirections redirections;
  redirections.add(STDOUT_FILENO, out.descriptor());
  redirections.add(STDERR_FILENO, err.descriptor());
  Ended ended = run(words, redirections);
  ended.out = out.read();
  ended.err = err.read();
  return ended;
}

int run_program(const std::vector<std::string>& words) {
  const Ended ended = run(words, Redirections());
  if (ended.error != 0)
    throw RunError(fmt::format("{}: cannot be run: {}", words.front(), std::strerror(ended.error)));
  return ended.exit_code;
}

}  // namespace glocal::app
