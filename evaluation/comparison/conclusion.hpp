// What the numbers of a comparison say, in words.
#pragma once

#include <string>
#include <vector>

#include "evaluation/comparison/comparison.hpp"

namespace glocal {

/// One sentence: in what the variant is significantly better or worse, or that nothing can be told.
[[nodiscard]] std::string conclude(const PairComparison& pair, const std::string& baseline,
                                   std::size_t starts);

/// What the pair has too few starts for, a sentence each.
[[nodiscard]] std::vector<std::string> pair_warnings(const PairComparison& pair);

}  // namespace glocal
