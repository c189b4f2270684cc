// What the numbers of a comparison say, in words.
#pragma once

#include <string>
#include <vector>

#include "evaluation/comparison/comparison.hpp"

namespace glocal {

/// In what the variant is significantly better or worse, in the order of what matters: wrong, right, steps
/// and errors, time. Where nothing can be told of wrong or right, how many more places it would take.
[[nodiscard]] std::string conclude(const PairComparison& pair, const std::string& baseline);

/// What the pair has too few places for, a sentence each.
[[nodiscard]] std::vector<std::string> pair_warnings(const PairComparison& pair);

}  // namespace glocal
