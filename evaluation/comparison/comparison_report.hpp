// A comparison for people to read.
#pragma once

#include "evaluation/comparison/comparison.hpp"
#include "evaluation/results/report_blocks.hpp"

namespace glocal {

/// A line and a sentence for each method, and a table by case.
[[nodiscard]] Report first_screen(const Comparison& comparison);

/// The same with all tests, and how to read them. `parameters` tell what is behind the differences; they come
/// after them.
[[nodiscard]] Report comparison_report(const Comparison& comparison, const Report& parameters = {});

}  // namespace glocal
