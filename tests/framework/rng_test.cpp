#include "glocal/rng.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace glocal::rng_test {
namespace {

TEST(Rng, IsSplitMix64) {
  // First outputs for seed 1234567 as published with the algorithm (Rosetta Code, "Pseudo-random
  // numbers/Splitmix64").
  Rng rng(1234567);
  EXPECT_EQ(rng.next(), 6457827717110365317ULL);
  EXPECT_EQ(rng.next(), 3203168211198807973ULL);
  EXPECT_EQ(rng.next(), 9817491932198370423ULL);
}

TEST(Rng, StreamsDifferAndDoNotAdvanceTheirParent) {
  const Rng parent(7);
  Rng a = parent.stream({1, 2});
  Rng again = parent.stream({1, 2});
  Rng b = parent.stream({2, 1});
  const auto first = a.next();
  EXPECT_EQ(first, again.next());
  EXPECT_NE(first, b.next());
}

TEST(Rng, BelowIsUniform) {
  Rng rng(3);
  std::array<int, 7> counts{};
  constexpr int draws = 70000;
  for (int i = 0; i < draws; ++i) ++counts.at(rng.below(7));
  double chi_square = 0.0;
  for (const int count : counts) chi_square += (count - 10000.0) * (count - 10000.0) / 10000.0;
  EXPECT_LT(chi_square, 22.46);  // 6 degrees of freedom, p = 0.001
}

TEST(Rng, NormalHasItsMoments) {
  Rng rng(5);
  double sum = 0.0;
  double squares = 0.0;
  constexpr int draws = 100000;
  for (int i = 0; i < draws; ++i) {
    const double value = rng.normal(2.0);
    sum += value;
    squares += value * value;
  }
  EXPECT_NEAR(sum / draws, 0.0, 4.0 * 2.0 / std::sqrt(draws));
  EXPECT_NEAR(squares / draws, 4.0, 4.0 * 4.0 * std::sqrt(2.0 / draws));
}

}  // namespace
}  // namespace glocal::rng_test
