// Hypotheses of which only the score matters.
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "glocal/strategies.hpp"

namespace glocal::test {

/// In the order given, which should be falling.
inline std::vector<Hypothesis> with_scores(const std::vector<double>& scores) {
  std::vector<Hypothesis> hypotheses;
  for (const double score : scores) hypotheses.push_back({.map_from_local = {}, .score = score});
  return hypotheses;
}

/// A threshold policy that has only seen steps of equal scores, so many of n points in contact, is not above
/// them by rounding: no hypothesis would reach it.
inline void expect_reached_by_equal_scores(ThresholdPolicy&& threshold) {
  for (int n = 1; n <= 60; ++n) {
    for (int k = 1; k <= n; ++k) {
      const double score = static_cast<double>(k) / n;
      threshold.reset();
      for (int step = 0; step < 60; ++step) threshold.update(with_scores({score, score, score}));
      ASSERT_LE(threshold.omega_max(), score) << k << " of " << n;
      ASSERT_NEAR(threshold.omega_max(), score, 1e-12);
    }
  }
}

}  // namespace glocal::test
