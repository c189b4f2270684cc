// Cases that differ from others by one thing that goes wrong.
#pragma once

#include <vector>

#include "config/products.hpp"

namespace glocal {

/// The key of an experiment, and of a suite.
inline constexpr const char* disturbances_key = "disturbances";

/// Puts behind each case those that differ from it by one disturbance, CASE_KIND-LEVEL. `written` is `map:
/// {KIND: levels}` and `observations: {KIND: levels}`, levels as seeds are written; kinds are those of the
/// sources called `disturbed`, and are judged with them. Appends to `faults` what is wrong.
void add_disturbed_cases(const YamlNode& written, std::vector<ExperimentPart>& cases,
                         std::vector<Fault>& faults);

}  // namespace glocal
