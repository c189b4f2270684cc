// Numbers as a report has them: it is for looking at, and shorter text makes it smaller.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace glocal {

/// To so many significant digits, whole ones without a decimal point.
[[nodiscard]] nlohmann::ordered_json short_number(double value, int digits = 7);

/// The nearest multiple of 1 / `per_unit`; null for what is no number.
[[nodiscard]] nlohmann::ordered_json rounded(double value, double per_unit);

/// The same with short_number()s in the place of all floating-point numbers but those of this key. Large ones
/// keep three decimals: places far from a map's origin.
[[nodiscard]] nlohmann::ordered_json with_short_numbers(nlohmann::ordered_json json, const char* but_of);

}  // namespace glocal
