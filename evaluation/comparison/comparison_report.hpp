// A comparison for people to read.
#pragma once

#include <string>

#include "evaluation/comparison/comparison.hpp"

namespace glocal {

/// For a terminal.
[[nodiscard]] std::string text_report(const Comparison& comparison);

/// The same as Markdown.
[[nodiscard]] std::string markdown_report(const Comparison& comparison);

}  // namespace glocal
