#include "matchers/mcl/beam_model.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace glocal::mcl::beam_model_test {
namespace {

/// The density over all ranges, by the midpoint rule, and the probability of none.
double total(double expected, const BeamModelRule& rule) {
  constexpr int n = 200000;
  const double step = rule.max_range / n;
  double sum = 0.0;
  for (int i = 0; i < n; ++i) sum += step * beam_likelihood((i + 0.5) * step, expected, rule);
  return sum + beam_likelihood(met_nothing, expected, rule);
}

TEST(BeamModel, AddsUpToOneOverAllThatCanBeMeasured) {
  const BeamModelRule amcl{.max_range = 20.0};
  const BeamModelRule sharp{.z_hit = 0.7,
                            .z_short = 0.2,
                            .z_max = 0.05,
                            .z_rand = 0.05,
                            .sigma_hit = 0.05,
                            .lambda_short = 2.0,
                            .max_range = 8.0};
  for (const double expected : {0.1, 1.0, 5.0, 7.95, met_nothing}) {
    EXPECT_NEAR(total(expected, amcl), 1.0, 1e-4) << expected;
    EXPECT_NEAR(total(expected, sharp), 1.0, 1e-4) << expected;
  }
}

TEST(BeamModel, EachPartAloneIsWhatItIsCalled) {
  const BeamModelRule hit{.z_hit = 1.0, .z_short = 0.0, .z_max = 0.0, .z_rand = 0.0, .max_range = 10.0};
  // The normal density with a deviation of 0.2 m at its mean and one deviation off.
  EXPECT_NEAR(beam_likelihood(5.0, 5.0, hit), 1.994711, 1e-5);
  EXPECT_NEAR(beam_likelihood(5.2, 5.0, hit), 1.209854, 1e-5);
  BeamModelRule early = hit;
  early.z_hit = 0.0;
  early.z_short = 1.0;
  early.lambda_short = 0.5;
  // 0.5 exp(-0.5) / (1 - exp(-2)) before what is expected at 4 m, nothing after it.
  EXPECT_NEAR(beam_likelihood(1.0, 4.0, early), 0.350735, 1e-5);
  EXPECT_EQ(beam_likelihood(4.1, 4.0, early), 0.0);
  BeamModelRule random = hit;
  random.z_hit = 0.0;
  random.z_rand = 1.0;
  EXPECT_DOUBLE_EQ(beam_likelihood(3.3, 4.0, random), 0.1);
}

TEST(BeamModel, WhereNothingIsToBeMetToMeetNothingIsTheHit) {
  const BeamModelRule rule{.z_hit = 0.6, .z_short = 0.1, .z_max = 0.1, .z_rand = 0.2, .max_range = 10.0};
  EXPECT_NEAR(beam_likelihood(met_nothing, met_nothing, rule), 0.7, 1e-12);
  EXPECT_NEAR(beam_likelihood(met_nothing, 4.0, rule), 0.1, 1e-12);
}

TEST(BeamModel, OnlySharesOfTheWeightsCount) {
  const BeamModelRule one{.z_hit = 0.5, .z_short = 0.1, .z_max = 0.1, .z_rand = 0.3};
  const BeamModelRule two{.z_hit = 1.0, .z_short = 0.2, .z_max = 0.2, .z_rand = 0.6};
  for (const double measured : {0.5, 3.0, met_nothing})
    EXPECT_NEAR(beam_likelihood(measured, 3.0, one), beam_likelihood(measured, 3.0, two), 1e-12);
}

TEST(BeamModel, AgainstAWallNothingIsTooShort) {
  EXPECT_TRUE(std::isfinite(beam_likelihood(0.0, 0.0, {})));
}

}  // namespace
}  // namespace glocal::mcl::beam_model_test
