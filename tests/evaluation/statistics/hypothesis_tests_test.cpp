#include "evaluation/statistics/hypothesis_tests.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "glocal/rng.hpp"

namespace glocal::hypothesis_tests_test {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::IsEmpty;

/// Pairs that differ by one, in both ways.
double p_of_pairs(std::size_t less, std::size_t more) {
  std::vector<long> differences(less, -1);
  differences.resize(less + more, 1);
  differences.resize(differences.size() + 5, 0);
  return sign_flip_test(differences).p;
}

TEST(SignFlips, OfSinglePairsAreMcNemarsTest) {
  // 2 (C(8,0) + C(8,1)) / 2^8 = 18 / 256: Bentur et al. (2009), 0.0703 in Fagerland et al. (2017), chapter 8.
  EXPECT_DOUBLE_EQ(p_of_pairs(1, 7), 18.0 / 256.0);
  EXPECT_DOUBLE_EQ(p_of_pairs(7, 1), 18.0 / 256.0);
  // 2 / 2^5 and 2 / 2^6: the first number of pairs that can be significant is 6.
  EXPECT_DOUBLE_EQ(p_of_pairs(0, 5), 0.0625);
  EXPECT_DOUBLE_EQ(p_of_pairs(6, 0), 0.03125);
  // 2 (1 + 10 + 45) / 2^10
  EXPECT_DOUBLE_EQ(p_of_pairs(8, 2), 112.0 / 1024.0);
}

TEST(SignFlips, FindNothingWhereBothAreAlike) {
  EXPECT_EQ(p_of_pairs(0, 0), 1.0);
  EXPECT_EQ(p_of_pairs(1, 1), 1.0);
  EXPECT_EQ(p_of_pairs(500, 500), 1.0);
  EXPECT_EQ(sign_flip_test({3, -1, -2}).p, 1.0);
}

TEST(SignFlips, KeepPlacesTogether) {
  // 3 seeds at one place are one difference, however large: 2 of 4 ways are as far from 0.
  const SignFlips test = sign_flip_test({3, 0, 1});
  EXPECT_EQ(test.differing, 2U);
  EXPECT_EQ(test.sum, 4);
  EXPECT_DOUBLE_EQ(test.p, 0.5);
}

TEST(SignFlips, AgreeWithEveryWayToGiveSigns) {
  Rng rng(11);
  for (std::size_t n = 1; n <= 14; ++n) {
    std::vector<long> differences;
    long sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
      differences.push_back(static_cast<long>(rng.below(8)) - 3);
      sum += differences.back();
    }
    std::size_t as_far = 0;
    for (std::size_t signs = 0; signs < std::size_t{1} << n; ++signs) {
      long other = 0;
      for (std::size_t i = 0; i < n; ++i) other += (signs >> i & 1U) != 0 ? differences[i] : -differences[i];
      as_far += std::abs(other) >= std::abs(sum) ? 1 : 0;
    }
    EXPECT_DOUBLE_EQ(sign_flip_test(differences).p,
                     static_cast<double>(as_far) / std::exp2(static_cast<double>(n)))
        << n;
  }
}

TEST(SignFlips, OfThousandsOfPlacesAreThoseOfANormal) {
  // 3000 ones, 1600 of them positive: 200 is 3.6515 standard deviations of sqrt(3000); with the continuity of
  // steps of 2 it is 199.
  EXPECT_NEAR(p_of_pairs(1400, 1600), std::erfc(199.0 / std::sqrt(3000.0) / std::sqrt(2.0)), 2e-6);
}

TEST(SignedRankTest, AgreesWithTheDepressionData) {
  // Hollander and Wolfe (1973), page 29; R: wilcox.test(x, y, paired = TRUE) says V = 40, p = 0.03906.
  const SignedRank test =
      wilcoxon_signed_rank({1.83 - 0.878, 0.50 - 0.647, 1.62 - 0.598, 2.48 - 2.05, 1.68 - 1.06, 1.88 - 1.29,
                            1.55 - 1.06, 3.06 - 3.14, 1.30 - 1.29});
  EXPECT_EQ(test.nonzero, 9U);
  EXPECT_EQ(test.positive_sum, 40.0);
  EXPECT_EQ(test.expected_sum, 22.5);
  EXPECT_TRUE(test.exact);
  EXPECT_DOUBLE_EQ(test.p, 2.0 * 10.0 / 512.0);
}

TEST(SignedRankTest, HalfWayIsNoDifference) {
  const SignedRank test = wilcoxon_signed_rank({1.0, -2.0, -3.0, 4.0});
  EXPECT_EQ(test.positive_sum, test.expected_sum);
  EXPECT_EQ(test.p, 1.0);
}

TEST(SignedRankTest, DropsZeros) {
  const SignedRank with = wilcoxon_signed_rank({0.0, 1.5, 0.0, -0.5, 2.5, -0.0});
  const SignedRank without = wilcoxon_signed_rank({1.5, -0.5, 2.5});
  EXPECT_EQ(with.nonzero, 3U);
  EXPECT_EQ(with.positive_sum, 5.0);
  EXPECT_EQ(with.p, without.p);
  for (const auto& none : {std::vector<double>{}, std::vector<double>{0.0, 0.0}}) {
    EXPECT_EQ(wilcoxon_signed_rank(none).nonzero, 0U);
    EXPECT_EQ(wilcoxon_signed_rank(none).p, 1.0);
  }
}

/// Mean rank of each size, by counting those below it.
std::vector<double> ranks_by_counting(const std::vector<double>& differences) {
  std::vector<double> ranks;
  for (const double d : differences) {
    double below = 0.0;
    double equal = 0.0;
    for (const double other : differences) {
      below += std::abs(other) < std::abs(d) ? 1.0 : 0.0;
      equal += std::abs(other) == std::abs(d) ? 1.0 : 0.0;
    }
    ranks.push_back(below + (equal + 1.0) / 2.0);
  }
  return ranks;
}

/// Share of all 2^n ways to give signs whose sum of positive ranks is as far from the middle, or farther.
double p_by_enumeration(const std::vector<double>& differences) {
  const std::vector<double> ranks = ranks_by_counting(differences);
  double middle = 0.0;
  double observed = 0.0;
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    middle += ranks[i] / 2.0;
    observed += differences[i] > 0.0 ? ranks[i] : 0.0;
  }
  std::size_t as_far = 0;
  for (std::size_t signs = 0; signs < std::size_t{1} << ranks.size(); ++signs) {
    double sum = 0.0;
    for (std::size_t i = 0; i < ranks.size(); ++i) sum += (signs >> i & 1U) != 0 ? ranks[i] : 0.0;
    as_far += std::abs(sum - middle) >= std::abs(observed - middle) ? 1 : 0;
  }
  return static_cast<double>(as_far) / std::exp2(static_cast<double>(ranks.size()));
}

TEST(SignedRankTest, AgreesWithEveryWayToGiveSigns) {
  Rng rng(1);
  for (std::size_t n = 1; n <= 14; ++n) {
    for (const bool tied : {false, true}) {
      std::vector<double> differences;
      for (std::size_t i = 0; i < n; ++i) {
        const double value = rng.uniform(-2.0, 3.0);
        // Of whole numbers from 1 to 3 many are equal.
        differences.push_back(tied ? std::copysign(1.0 + std::floor(std::abs(value)), value) : value);
      }
      EXPECT_DOUBLE_EQ(wilcoxon_signed_rank(differences).p, p_by_enumeration(differences))
          << n << (tied ? " tied" : "");
    }
  }
}

TEST(SignedRankTest, ApproximatesManyByHand) {
  // 1 to 60, those up to 40 negative: V = 41 + ... + 60 = 1010, the mean is 915 and the variance
  // 60 * 61 * 121 / 24 = 18452.5.
  std::vector<double> differences;
  for (int i = 1; i <= 60; ++i) differences.push_back(i <= 40 ? -i : i);
  SignedRank test = wilcoxon_signed_rank(differences);
  EXPECT_FALSE(test.exact);
  EXPECT_EQ(test.positive_sum, 1010.0);
  EXPECT_NEAR(test.p, std::erfc((95.0 - 0.5) / std::sqrt(18452.5) / std::sqrt(2.0)), 1e-12);
  // 60 equal sizes, 38 of them positive: each has rank 30.5, V = 1159, and the sign test's variance
  // 60 * 30.5^2 / 4 = 13953.75.
  differences.assign(38, 2.0);
  differences.resize(60, -2.0);
  test = wilcoxon_signed_rank(differences);
  EXPECT_EQ(test.positive_sum, 1159.0);
  EXPECT_NEAR(test.p, std::erfc((244.0 - 0.5) / std::sqrt(13953.75) / std::sqrt(2.0)), 1e-12);
}

TEST(SignedRankTest, ExactAndApproximateMeetAtTheLimit) {
  Rng rng(2);
  for (int repeat = 0; repeat < 20; ++repeat) {
    std::vector<double> differences;
    for (std::size_t i = 0; i < most_exact_differences; ++i) differences.push_back(rng.uniform(-1.0, 1.3));
    const SignedRank exact = wilcoxon_signed_rank(differences);
    ASSERT_TRUE(exact.exact);
    const double z = (std::abs(exact.positive_sum - 637.5) - 0.5) / std::sqrt(50.0 * 51.0 * 101.0 / 24.0);
    EXPECT_NEAR(exact.p, std::erfc(z / std::sqrt(2.0)), 0.005);
  }
}

TEST(FisherExact, AgreesWithExamplesByHand) {
  // Fisher's tea: (16 + 1) of the 70 ways to choose 4 of 8 cups have 3 or more right, and as many 1 or fewer.
  EXPECT_NEAR(fisher_exact({3, 4}, {1, 4}), 34.0 / 70.0, 1e-12);
  EXPECT_NEAR(fisher_exact({0, 8}, {8, 8}), 2.0 / 12870.0, 1e-12);
  EXPECT_NEAR(fisher_exact({1, 12}, {9, 12}), fisher_exact({9, 12}, {1, 12}), 1e-12);
  // R: fisher.test(matrix(c(1, 9, 11, 3), 2))
  EXPECT_NEAR(fisher_exact({1, 10}, {11, 14}), 0.002759456, 1e-9);
}

TEST(FisherExact, FindsNothingWhereBothAreAlikeOrEmpty) {
  EXPECT_NEAR(fisher_exact({30, 40}, {30, 40}), 1.0, 1e-9);
  EXPECT_EQ(fisher_exact({0, 40}, {0, 50}), 1.0);
  EXPECT_EQ(fisher_exact({0, 0}, {0, 0}), 1.0);
  EXPECT_EQ(fisher_exact({0, 0}, {3, 5}), 1.0);
  EXPECT_NEAR(fisher_exact({2000, 5000}, {2600, 5000}), 0.0, 1e-9);
}

TEST(LeastP, IsReachedByPairsThatAllDifferTheSameWay) {
  for (std::size_t n = 0; n < 12; ++n) {
    EXPECT_DOUBLE_EQ(least_p(n), sign_flip_test(std::vector<long>(n, 2)).p);
    EXPECT_DOUBLE_EQ(least_p(n), wilcoxon_signed_rank(std::vector<double>(n, 1.0)).p);
  }
}

TEST(Holm, AgreesWithAnExampleByHand) {
  // Sorted 0.005, 0.01, 0.03, 0.04, times 4, 3, 2, 1: 0.02, 0.03, 0.06, 0.04, and none less than the one
  // before.
  EXPECT_THAT(holm({0.01, 0.04, 0.03, 0.005}), ElementsAre(DoubleNear(0.03, 1e-12), DoubleNear(0.06, 1e-12),
                                                           DoubleNear(0.06, 1e-12), DoubleNear(0.02, 1e-12)));
}

TEST(Holm, StaysAProbability) {
  EXPECT_THAT(holm({0.6, 0.5}), ElementsAre(1.0, 1.0));
  EXPECT_THAT(holm({0.03}), ElementsAre(0.03));
  EXPECT_THAT(holm({}), IsEmpty());
}

}  // namespace
}  // namespace glocal::hypothesis_tests_test
