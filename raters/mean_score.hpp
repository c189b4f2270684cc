// Score of several hypotheses together.
#pragma once

#include <span>
#include <vector>

#include "glocal/hypothesis.hpp"

namespace glocal::raters {

/// Mean score of hypotheses, each counted as often as its support says; 0 without any.
[[nodiscard]] double mean_score(const std::vector<Hypothesis>& hypotheses);

/// The same of some of them.
[[nodiscard]] double mean_score(const std::vector<Hypothesis>& hypotheses,
                                std::span<const std::size_t> members);

}  // namespace glocal::raters
