// What a verdict rule says of one step after the other.
#pragma once

#include <vector>

#include "glocal/strategies.hpp"

namespace glocal::test {

/// Of each step, which kind of verdict it ends with.
[[nodiscard]] inline std::vector<VerdictKind> kinds(VerdictRule& rule, const std::vector<StepResult>& steps) {
  std::vector<VerdictKind> all;
  for (const StepResult& step : steps) all.push_back(rule.judge(step).kind);
  return all;
}

}  // namespace glocal::test
