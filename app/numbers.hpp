// Checks of numbers on the command line. Those of CLI11 take what is no number, or infinity.
#pragma once

#include <CLI/CLI.hpp>

namespace glocal::app {

[[nodiscard]] CLI::Validator within(double low, double high);
[[nodiscard]] CLI::Validator above_zero();
[[nodiscard]] CLI::Validator from_zero();

}  // namespace glocal::app
