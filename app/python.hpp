// Python, as a program of its own.
#pragma once

#include <string>
#include <vector>

namespace glocal::app {

/// A Python that has matplotlib: `named`, or, if that is empty, python3 of PATH, or else Debian's. Throws
/// RunError that tells what was tried.
[[nodiscard]] std::string python_with_matplotlib(const std::string& named);

/// Runs a program, found on PATH, without a shell; its output is the program's own. Returns its exit code, or
/// 128 + the signal that ended it. Throws RunError if it cannot be started.
[[nodiscard]] int run_program(std::vector<std::string> words);

}  // namespace glocal::app
