// Hypotheses of which only the quality matters.
#pragma once

#include <vector>

#include "glocal/hypothesis.hpp"

namespace glocal::test {

/// In the order given, which should be falling.
inline std::vector<Hypothesis> with_qualities(const std::vector<double>& qualities) {
  std::vector<Hypothesis> hypotheses;
  for (const double quality : qualities) hypotheses.push_back({{}, {}, quality});
  return hypotheses;
}

}  // namespace glocal::test
