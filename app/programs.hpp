// Other programs.
#pragma once

#include <string>
#include <vector>

namespace glocal::app {

/// What a program has come to.
struct Ended {
  int exit_code = 0;  ///< Or 128 + the signal that ended it.
  int error = 0;      ///< Why it could not be started (errno); 0 if it was.
  std::string out = {}, err = {};
};

/// Runs a program, found on PATH, without a shell, and reads what it says. Throws RunError if there is no
/// place to keep that.
[[nodiscard]] Ended ask_program(const std::vector<std::string>& words);

/// The same with output that is the program's own. Returns its exit code, or 128 + the signal that ended it.
/// Throws RunError if it cannot be started.
[[nodiscard]] int run_program(const std::vector<std::string>& words);

}  // namespace glocal::app
