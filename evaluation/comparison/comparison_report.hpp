// A comparison for people to read.
#pragma once

#include "evaluation/comparison/comparison.hpp"
#include "evaluation/results/report_blocks.hpp"

namespace glocal {

/// `parameters` tell what is behind the differences; they come after them.
[[nodiscard]] Report comparison_report(const Comparison& comparison, const Report& parameters = {});

}  // namespace glocal
