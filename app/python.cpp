#include "app/python.hpp"

#include <fmt/format.h>

#include <cstring>
#include <optional>
#include <vector>

#include "app/programs.hpp"
#include "glocal/error.hpp"

namespace glocal::app {
namespace {

/// Why a Python is of no use here; none if it is.
std::optional<std::string> why_useless(const std::string& python) {
  const Ended ended = ask_program({python, "-c", "import matplotlib"});
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

}  // namespace glocal::app
