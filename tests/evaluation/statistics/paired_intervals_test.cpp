#include "evaluation/statistics/paired_intervals.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "evaluation/statistics/statistics.hpp"

namespace glocal::paired_intervals_test {
namespace {

TEST(NewcombePaired, AgreesWithPublishedIntervals) {
  // Cavo et al. (2012), 59, 6, 16, 80 (Fagerland, Lydersen and Laake 2017, chapter 8): first less second is
  // -0.0621 (-0.1186 to -0.0046).
  Interval interval = newcombe_paired({59, 6, 16, 80});
  EXPECT_NEAR(interval.low, 0.0046, 5e-5);
  EXPECT_NEAR(interval.high, 0.1186, 5e-5);
  // Altman et al. (2000), table 6.2: 14, 5, 0, 22; 0.122 (0.011 to 0.226).
  interval = newcombe_paired({14, 0, 5, 22});
  EXPECT_NEAR(interval.low, 0.011, 5e-4);
  EXPECT_NEAR(interval.high, 0.226, 5e-4);
}

TEST(NewcombePaired, SwappingTheTwoTurnsItRound) {
  const Interval one = newcombe_paired({20, 7, 3, 12});
  const Interval other = newcombe_paired({20, 3, 7, 12});
  EXPECT_DOUBLE_EQ(one.low, -other.high);
  EXPECT_DOUBLE_EQ(one.high, -other.low);
}

TEST(NewcombePaired, SaysSomethingWhereNoPairDiffers) {
  // Without spread there is no correlation: both bounds are the width of Wilson's interval of 20 of 20.
  const Interval interval = newcombe_paired({20, 0, 0, 0});
  EXPECT_NEAR(interval.low, -3.841459 / 23.841459, 1e-6);
  EXPECT_NEAR(interval.high, 3.841459 / 23.841459, 1e-6);
  EXPECT_EQ(newcombe_paired({}).low, -1.0);
  EXPECT_EQ(newcombe_paired({}).high, 1.0);
}

/// Chance of one way to fall into four cells.
double multinomial(const PairedCounts& n, double both, double first, double second, double neither) {
  const auto log_power = [](std::size_t k, double p) {
    const auto count = static_cast<double>(k);
    return count * std::log(p) - std::lgamma(count + 1.0);
  };
  const auto total = static_cast<double>(n.both + n.only_first + n.only_second + n.neither);
  return std::exp(std::lgamma(total + 1.0) + log_power(n.both, both) + log_power(n.only_first, first) +
                  log_power(n.only_second, second) + log_power(n.neither, neither));
}

TEST(NewcombePaired, CoversTheTruthInAboutNineteenOfTwentyCases) {
  // Over all ways in which 30 pairs can fall.
  constexpr std::size_t pairs = 30;
  double covered = 0.0;
  for (std::size_t a = 0; a <= pairs; ++a) {
    for (std::size_t b = 0; a + b <= pairs; ++b) {
      for (std::size_t c = 0; a + b + c <= pairs; ++c) {
        const PairedCounts counts{a, b, c, pairs - a - b - c};
        const Interval interval = newcombe_paired(counts);
        if (interval.low <= 0.1 && 0.1 <= interval.high) covered += multinomial(counts, 0.6, 0.1, 0.2, 0.1);
      }
    }
  }
  EXPECT_GT(covered, 0.94);
  EXPECT_LT(covered, 0.98);
}

TEST(Bootstrap, OfANormalMeanIsItsStandardError) {
  Rng rng(5);
  std::vector<double> values;
  for (int i = 0; i < 400; ++i) values.push_back(3.0 + rng.normal(2.0));
  const double middle = mean(values);
  double squares = 0.0;
  for (const double value : values) squares += (value - middle) * (value - middle);
  const double standard_error = std::sqrt(squares) / 400.0;
  const Interval interval = bootstrap(values, mean, Rng(1));
  // 10,000 resamples know a bound to about 3 % of the standard error.
  EXPECT_NEAR(interval.low, middle - 1.959964 * standard_error, 0.1 * standard_error);
  EXPECT_NEAR(interval.high, middle + 1.959964 * standard_error, 0.1 * standard_error);
}

TEST(Bootstrap, OfFewValuesFollowsFromAllTheirResamples) {
  // The mean of two of 0 and 1 is 0 or 1 with a chance of 1 in 4 each.
  Interval interval = bootstrap({0.0, 1.0}, mean, Rng(1));
  EXPECT_EQ(interval.low, 0.0);
  EXPECT_EQ(interval.high, 1.0);
  // A single value has but one resample.
  interval = bootstrap({4.0}, mean, Rng(1));
  EXPECT_EQ(interval.low, 4.0);
  EXPECT_EQ(interval.high, 4.0);
}

TEST(Bootstrap, FollowsFromItsRandomNumbers) {
  Rng rng(3);
  std::vector<double> values;
  for (int i = 0; i < 50; ++i) values.push_back(rng.uniform());
  const auto low = [&](std::uint64_t seed) { return bootstrap(values, mean, Rng(seed)).low; };
  EXPECT_EQ(low(1), low(1));
  EXPECT_NE(low(1), low(2));
}

}  // namespace
}  // namespace glocal::paired_intervals_test
