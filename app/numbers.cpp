#include "app/numbers.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <string>

namespace glocal::app {
namespace {

CLI::Validator finite(const std::function<bool(double)>& is_right, const std::string& which) {
  const auto fault = [=](const std::string& text) {
    double value = 0.0;
    const bool is_number = CLI::detail::lexical_cast(text, value) && std::isfinite(value);
    return is_number && is_right(value) ? std::string() : fmt::format("{} is not a number {}", text, which);
  };
  return {fault, which};
}

}  // namespace

CLI::Validator within(double low, double high) {
  return finite([=](double value) { return value >= low && value <= high; },
                fmt::format("from {} to {}", low, high));
}

CLI::Validator above_zero() {
  return finite([](double value) { return value > 0.0; }, "above 0");
}

CLI::Validator from_zero() {
  return finite([](double value) { return value >= 0.0; }, "from 0 on");
}

}  // namespace glocal::app
