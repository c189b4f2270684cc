// Settings whose values are drawn from ranges.
#pragma once

#include <vector>

#include "config/variants.hpp"

namespace glocal {

/// The points of variants.sample, named `sample-0001` and so on. Numbers have six significant digits, and
/// whole numbers where `experiment` takes these. What is wrong with ranges goes to `faults`.
[[nodiscard]] std::vector<VariantChanges> sampled_settings(const SampleSection& section,
                                                           AnyParams& experiment, std::vector<Fault>& faults);

}  // namespace glocal
