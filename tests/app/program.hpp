// Runs the program as its users do.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "temporary_folder.hpp"

namespace glocal::test {

struct Answer {
  int exit_code;
  std::string out;
  std::string err;
};

/// The answer of a command that has done what it was asked to; the test ends here if it has not.
inline Answer good(Answer answer, const char* file = __builtin_FILE(), int line = __builtin_LINE()) {
  if (answer.exit_code == 0) return answer;
  ADD_FAILURE_AT(file, line) << "exit code " << answer.exit_code << "\n" << answer.err;
  throw std::runtime_error("the test cannot go on");
}

/// What a command says that is refused.
inline std::string refusal(const Answer& answer, int exit_code = 2, const char* file = __builtin_FILE(),
                           int line = __builtin_LINE()) {
  if (answer.exit_code != exit_code)
    ADD_FAILURE_AT(file, line) << "exit code " << answer.exit_code << "\n" << answer.err;
  return answer.err;
}

/// Works in a folder of its own: relative paths begin there.
class CommandLine : public testing::Test {
 protected:
  CommandLine() { std::filesystem::current_path(folder_.path()); }
  ~CommandLine() override { std::filesystem::current_path(before_); }

  [[nodiscard]] Answer run(const std::string& arguments) const {
    const std::string out = folder_.path() / "out";
    const std::string err = folder_.path() / "err";
    const int status = std::system((GLOCAL_PROGRAM " " + arguments + " >" + out + " 2>" + err).c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content(out), content(err)};
  }

  static std::string content(const std::string& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
  }

  /// Its absolute path.
  [[nodiscard]] std::string file(const std::string& name) const { return folder_.path() / name; }

  /// world.yaml: a room with a wall in it, and a way through it.
  void write_world() const {
    folder_.write("world.yaml",
                  "size: [12, 6]\n"
                  "walls:\n"
                  "  - {points: [[0, 0], [12, 0], [12, 4], [7, 6], [0, 6]], closed: true}\n"
                  "  - {points: [[5, 0], [5, 2.4]]}\n"
                  "free_from: [[1, 1]]\n"
                  "way_points: [[1, 3], [10, 3], [10, 1]]\n");
  }

  /// room/map.yaml and room/drive.log: that room, and a drive through it with a laser.
  void simulate_room() const {
    write_world();
    folder_.write("room.yaml",
                  "schema: 1\nname: room\n"
                  "map:\n  simulation: {world: world.yaml, resolution: 0.05}\n"
                  "observations:\n  simulation: {world: world.yaml, laser: {fov_deg: 270}}\n"
                  "trials: {whole: true}\n");
    good(run("simulate room.yaml --out room"));
  }

  TemporaryFolder folder_;

 private:
  const std::filesystem::path before_ = std::filesystem::current_path();
};

}  // namespace glocal::test
