// Hypotheses of which only the score matters.
#pragma once

#include <vector>

#include "glocal/hypothesis.hpp"

namespace glocal::test {

/// In the order given, which should be falling.
inline std::vector<Hypothesis> with_scores(const std::vector<double>& scores) {
  std::vector<Hypothesis> hypotheses;
  for (const double score : scores) hypotheses.push_back({.map_from_local = {}, .score = score});
  return hypotheses;
}

}  // namespace glocal::test
