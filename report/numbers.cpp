#include "report/numbers.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

namespace glocal {

using Json = nlohmann::ordered_json;

Json short_number(double value, int digits) {
  constexpr double whole_up_to = 1.0e7;
  if (std::abs(value) < whole_up_to && std::trunc(value) == value) return static_cast<std::int64_t>(value);
  std::array<char, 32> text{};
  const char* const end = fmt::format_to_n(text.data(), text.size(), "{:.{}g}", value, digits).out;
  double rounded = value;  // what is no number stays so
  std::from_chars(text.data(), end, rounded);
  return rounded;
}

Json rounded(double value, double per_unit) {
  if (!std::isfinite(value)) return nullptr;
  return short_number(std::round(value * per_unit) / per_unit, 15);
}

Json with_short_numbers(Json json, const char* but_of) {
  if (json.is_number_float()) {
    const auto value = json.get<double>();
    constexpr double largest = 1.0e10;
    const bool is_long = std::abs(value) >= 1.0e4 && std::abs(value) < largest;
    return is_long ? rounded(value, 1e3) : short_number(value);
  }
  if (json.is_array()) {
    for (Json& item : json) item = with_short_numbers(std::move(item), but_of);
  }
  if (json.is_object()) {
    for (auto& [key, value] : json.items()) {
      if (key != but_of) value = with_short_numbers(std::move(value), but_of);
    }
  }
  return json;
}

}  // namespace glocal
