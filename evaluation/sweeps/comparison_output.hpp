// All that is told of a comparison of runs: the differences, and what the parameters do that are behind them.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "evaluation/comparison/comparison.hpp"
#include "evaluation/results/report_blocks.hpp"

namespace glocal {

struct ComparisonOutput {
  Report brief;                 ///< For people: a line and a sentence for each method.
  Report full;                  ///< The same with all tests.
  nlohmann::ordered_json json;  ///< All numbers.
  std::string csv;              ///< A row for each variant and test.
};

/// Of compare(), which throws, and of compare_parameters().
[[nodiscard]] ComparisonOutput comparison_output(const std::vector<NamedRun>& runs, std::size_t baseline,
                                                 std::span<const Measure> measured);

}  // namespace glocal
