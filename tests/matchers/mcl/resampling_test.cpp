#include "matchers/mcl/resampling.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "glocal/rng.hpp"

namespace glocal::mcl::resampling_test {
namespace {

TEST(LowVarianceDraws, EachParticleAsOftenAsItsWeightSaysUpToRounding) {
  Rng rng(3);
  for (const std::size_t n : {1U, 7U, 100U, 1000U}) {
    std::vector<double> weights(50);
    double sum = 0.0;
    for (double& weight : weights) sum += weight = std::pow(rng.uniform(), 4.0);
    for (double& weight : weights) weight /= sum;
    const auto draws = low_variance_draws(weights, n, rng.uniform());
    ASSERT_EQ(draws.size(), n);
    EXPECT_TRUE(std::is_sorted(draws.begin(), draws.end()));
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const auto times = static_cast<double>(std::count(draws.begin(), draws.end(), i));
      const double expected = static_cast<double>(n) * weights[i];
      EXPECT_GE(times, std::floor(expected - 1e-9));
      EXPECT_LE(times, std::ceil(expected + 1e-9));
    }
  }
}

TEST(LowVarianceDraws, OverManyOffsetsOnAverageExactlyAsTheWeightsSay) {
  const std::vector<double> weights = {0.07, 0.0, 0.63, 0.3};
  std::vector<double> times(4, 0.0);
  constexpr int rounds = 1000;
  for (int i = 0; i < rounds; ++i) {
    for (const std::uint32_t k : low_variance_draws(weights, 5, (i + 0.5) / rounds)) times[k] += 1.0 / rounds;
  }
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(times[k], 5.0 * weights[k], 2e-3);
}

TEST(LowVarianceDraws, WeightsThatAddUpToALittleLessGiveAllDraws) {
  const auto draws = low_variance_draws({0.0, 0.3, 0.7 - 1e-9, 0.0}, 10, 1.0 - 1e-12);
  ASSERT_EQ(draws.size(), 10U);
  EXPECT_EQ(draws.front(), 1U);
  EXPECT_EQ(draws.back(), 2U);
}

/// Half the quantile of the chi-square distribution over the error is the bound that eq. 14 of Fox 2003
/// approximates; quantiles are from tables.
TEST(KldSampleSize, IsNearTheBoundFromTablesOfChiSquare) {
  constexpr double quantile_99 = 2.326;
  EXPECT_NEAR(kld_sample_size(11, 0.05, quantile_99), 23.209 / 0.1, 1.0);    // 10 degrees of freedom, 99 %
  EXPECT_NEAR(kld_sample_size(101, 0.05, quantile_99), 135.807 / 0.1, 2.0);  // 100
  EXPECT_NEAR(kld_sample_size(31, 0.01, 1.6449), 43.773 / 0.02, 3.0);        // 30, 95 %
  EXPECT_NEAR(kld_sample_size(6, 0.05, 0.0), 4.351 / 0.1, 0.6);              // 5, median
}

TEST(KldSampleSize, BinsAskForMoreAndOneForNone) {
  EXPECT_EQ(kld_sample_size(0, 0.05, 0.99), 1.0);
  EXPECT_EQ(kld_sample_size(1, 0.05, 0.99), 1.0);
  for (std::size_t bins = 2; bins < 100; ++bins) {
    EXPECT_GT(kld_sample_size(bins + 1, 0.05, 0.99), kld_sample_size(bins, 0.05, 0.99));
  }
}

TEST(RecoveryAverages, NewOnesWhenLikelihoodsFallAndNoneWhenTheyRise) {
  RecoveryAverages averages(0.1, 0.5);
  averages.add(1.0);
  EXPECT_EQ(averages.share_of_new(), 0.0);
  averages.add(0.2);  // slow: 1 - 0.1 * 0.8 = 0.92, fast: 1 - 0.5 * 0.8 = 0.6
  EXPECT_NEAR(averages.share_of_new(), 1.0 - 0.6 / 0.92, 1e-12);
  averages.add(3.0);  // slow: 1.128, fast: 1.8
  EXPECT_EQ(averages.share_of_new(), 0.0);
  averages.reset();
  EXPECT_EQ(averages.share_of_new(), 0.0);
}

TEST(RecoveryAverages, AreOffWithARateOfZero) {
  RecoveryAverages averages(0.0, 0.1);
  averages.add(1.0);
  averages.add(0.1);
  EXPECT_EQ(averages.share_of_new(), 0.0);
}

}  // namespace
}  // namespace glocal::mcl::resampling_test
