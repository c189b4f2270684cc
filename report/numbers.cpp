#include "report/numbers.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <nlohmann/json.hpp>

namespace glocal {

nlohmann::ordered_json short_number(double value) {
  constexpr double whole_up_to = 1.0e7;
  if (std::abs(value) < whole_up_to && std::trunc(value) == value) return static_cast<std::int64_t>(value);
  std::array<char, 32> text{};
  const char* const end = fmt::format_to_n(text.data(), text.size(), "{:.7g}", value).out;
  double rounded = value;  // what is no number stays so
  std::from_chars(text.data(), end, rounded);
  return rounded;
}

}  // namespace glocal
