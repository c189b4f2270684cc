#include "raters/fixed_threshold.hpp"

#include <gtest/gtest.h>

namespace glocal::raters::fixed_threshold_test {
namespace {

TEST(FixedThreshold, StaysWhateverTheHypothesesAre) {
  FixedThreshold policy({.omega_max = 0.35});
  EXPECT_EQ(policy.omega_max(), 0.35);
  policy.update({{{}, {}, 0.9}});
  policy.update({});
  EXPECT_EQ(policy.omega_max(), 0.35);
}

}  // namespace
}  // namespace glocal::raters::fixed_threshold_test
