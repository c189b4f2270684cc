// Numbers as a report has them.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace glocal {

/// To 7 significant digits, whole ones without a decimal point: a report is for looking at, and shorter text
/// makes it smaller.
[[nodiscard]] nlohmann::ordered_json short_number(double value);

}  // namespace glocal
