// Tests of paired differences, and what many tests at once ask for.
#pragma once

#include <cstddef>
#include <vector>

namespace glocal {

/// McNemar's test (1947), exact: how likely it is that pairs which differ do so at least as unevenly, if
/// either way is equally likely; two-sided. Arguments count pairs in which only the first, and only the
/// second has the property; 1 without any.
[[nodiscard]] double mcnemar_exact(std::size_t only_first, std::size_t only_second);

/// Wilcoxon's signed-rank test (1945), two-sided.
struct SignedRank {
  std::size_t nonzero = 0;    ///< Differences of 0 are dropped, as Wilcoxon did.
  double positive_sum = 0.0;  ///< Sum of the ranks of positive differences (R's V); ties share their ranks.
  double expected_sum = 0.0;  ///< Of the same, if either sign is equally likely.
  bool exact = true;          ///< Over all signs of the ranks there are, tied or not; else the normal
                              ///< approximation, corrected for ties and continuity.
  double p = 1.0;
};
[[nodiscard]] SignedRank wilcoxon_signed_rank(const std::vector<double>& differences);

/// What a signed-rank test is about: by how much pairs differ that do.
struct ShiftEstimate {
  double value = 0.0;            ///< Median of the means of all pairs of differences, each with itself, too.
  double low = 0.0, high = 0.0;  ///< 95 %, from the test's own distribution.
};
/// The estimate of Hodges and Lehmann (1963) with its interval, of differences that are not 0, as in the
/// test: 0 without any. The interval takes differences for untied; with fewer than 6 it has all means, and
/// less than 95 %.
[[nodiscard]] ShiftEstimate hodges_lehmann(const std::vector<double>& differences);

/// Up to so many differences that are not 0 the signed-rank test is exact (scipy's limit, too).
inline constexpr std::size_t most_exact_differences = 50;

/// The least p either test can have with so many pairs that differ.
[[nodiscard]] double least_p(std::size_t differing_pairs);

/// Adjusted p-values after Holm (1979), in the order of the given ones: with those below alpha taken for
/// significant, the chance of any mistake in the whole family is at most alpha.
[[nodiscard]] std::vector<double> holm(const std::vector<double>& p);

}  // namespace glocal
