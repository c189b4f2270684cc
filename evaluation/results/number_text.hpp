// Numbers that are all of a text.
#pragma once

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace glocal {

/// None if there is anything else, or a number that this type does not have. `base` may be that of a whole
/// number.
template <class Number, class... Base>
[[nodiscard]] std::optional<Number> number_of(std::string_view text, Base... base) {
  Number value{};
  const char* const end = text.data() + text.size();
  const auto [last, error] = std::from_chars(text.data(), end, value, base...);
  if (error != std::errc() || last != end) return std::nullopt;
  return value;
}

}  // namespace glocal
