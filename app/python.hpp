// Python, as a program of its own.
#pragma once

#include <string>

namespace glocal::app {

/// A Python that has matplotlib: `named`, or, if that is empty, python3 of PATH, or else Debian's. Throws
/// RunError that tells what was tried.
[[nodiscard]] std::string python_with_matplotlib(const std::string& named);

}  // namespace glocal::app
