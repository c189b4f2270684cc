#include "evaluation/statistics/reliability.hpp"

#include <gtest/gtest.h>

namespace glocal::reliability_test {
namespace {

TEST(Reliability, CountsInBinsByConfidence) {
  Reliability reliability;
  for (const double c : {0.3, 0.4, 0.49}) reliability.add(c, c < 0.4);
  reliability.add(0.5, true);
  reliability.add(1.0, true);
  reliability.add(0.0, false);
  const auto bins = reliability.bins();
  ASSERT_EQ(bins.size(), 4U);
  EXPECT_EQ(bins[0].low, 0.0);
  EXPECT_EQ(bins[0].right.value, 0.0);
  EXPECT_EQ(bins[1].low, 0.3);
  EXPECT_EQ(bins[1].high, 0.5);
  EXPECT_EQ(bins[1].count, 3U);
  EXPECT_NEAR(bins[1].mean_confidence, 1.19 / 3.0, 1e-12);
  EXPECT_NEAR(bins[1].right.value, 1.0 / 3.0, 1e-12);
  EXPECT_EQ(bins[2].low, 0.5);
  EXPECT_EQ(bins[3].high, 1.0);
}

TEST(Reliability, ABinIsOffIfItsConfidenceIsOutsideTheInterval) {
  // Wilson's interval of 81 of 263 is 0.2553 to 0.3662 (Newcombe 1998).
  for (const auto& [confidence, is_off] :
       {std::pair(0.31, false), std::pair(0.36, false), std::pair(0.40, true)}) {
    Reliability reliability;
    for (int i = 0; i < 263; ++i) reliability.add(confidence, i < 81);
    ASSERT_EQ(reliability.bins().size(), 1U);
    EXPECT_EQ(reliability.bins().front().is_off(), is_off) << confidence;
  }
}

}  // namespace
}  // namespace glocal::reliability_test
