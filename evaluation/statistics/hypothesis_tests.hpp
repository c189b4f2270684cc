// Tests of paired differences, and what many tests at once ask for.
#pragma once

#include <cstddef>
#include <vector>

#include "evaluation/statistics/statistics.hpp"

namespace glocal {

/// Whether the sum of differences at several places is more than chance: a permutation test. If two methods
/// are alike, either could have had the other's outcomes at any place, so that the sign of each difference is
/// equally likely either way. All trials of a place keep together.
struct SignFlips {
  std::size_t differing = 0;  ///< Places with a difference other than 0.
  long sum = 0;
  double p = 1.0;  ///< Share of all ways to give signs with a sum as far from 0, or farther; exact.
};
/// With differences of 1 this is McNemar's exact test (1947).
[[nodiscard]] SignFlips sign_flip_test(const std::vector<long>& differences);

/// Wilcoxon's signed-rank test (1945), two-sided: the same of the ranks of differences, so that a few large
/// ones do not outweigh all others.
struct SignedRank {
  std::size_t nonzero = 0;    ///< Differences of 0 are dropped, as Wilcoxon did.
  double positive_sum = 0.0;  ///< Sum of the ranks of positive differences (R's V); ties share their ranks.
  double expected_sum = 0.0;  ///< Of the same, if either sign is equally likely.
  bool exact = true;          ///< Over all signs of the ranks there are, tied or not; else the normal
                              ///< approximation, corrected for ties and continuity.
  double p = 1.0;
};
[[nodiscard]] SignedRank wilcoxon_signed_rank(const std::vector<double>& differences);

/// Up to so many differences that are not 0 the signed-rank test is exact (scipy's limit, too).
inline constexpr std::size_t most_exact_differences = 50;

/// Fisher's exact test (1935), two-sided, of two shares that have nothing to do with each other: the chance
/// of all divisions of as many successes among as many trials that are no likelier than this one. 1 without
/// trials.
[[nodiscard]] double fisher_exact(const TrialCluster& first, const TrialCluster& second);

/// The least p either test can have with so many differences that are not 0. It does not depend on which way
/// these go.
[[nodiscard]] double least_p(std::size_t differing);

/// Adjusted p-values after Holm (1979), in the order of the given ones: with those below alpha taken for
/// significant, the chance of any mistake in the whole family is at most alpha.
[[nodiscard]] std::vector<double> holm(const std::vector<double>& p);

}  // namespace glocal
