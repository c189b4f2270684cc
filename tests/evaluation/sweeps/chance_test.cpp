// The lead of the best of several equal settings, against all ways to exchange their outcomes.
#include "evaluation/sweeps/chance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "glocal/rng.hpp"

namespace glocal::test::chance_test {
namespace {

TEST(ChanceOfBest, OfTwoSettingsIsThatOfAllExchanges) {
  // At three places one of two settings is right: the best has 3 of them in 2 of 8 ways, and 2 in 6. The mean
  // is 1.5, so that the lead is 0.5 or 1/6 of a place: 1/4 in the mean.
  const auto chance = chance_of_best({{1, 0}, {1, 0}, {1, 0}}, 3);
  ASSERT_TRUE(chance.has_value());
  EXPECT_DOUBLE_EQ(chance->lead, 0.5);
  EXPECT_NEAR(chance->expected, 0.25, 0.02);
  EXPECT_DOUBLE_EQ(chance->high, 0.5);
  EXPECT_NEAR(chance->share, 0.25, 0.04);
  EXPECT_EQ(chance->settings, 2U);
  EXPECT_EQ(chance->places, 3U);
}

TEST(ChanceOfBest, CountsPlacesAtWhichAllEndTheSame) {
  // The same, and as many places at which both are right or wrong: half the lead.
  const auto chance = chance_of_best({{1, 0}, {1, 1}, {1, 0}, {-1, -1}, {1, 0}, {1, 1}}, 6);
  ASSERT_TRUE(chance.has_value());
  EXPECT_DOUBLE_EQ(chance->lead, 0.25);
  EXPECT_NEAR(chance->expected, 0.125, 0.01);
}

TEST(ChanceOfBest, TrialsOfAPlaceStayTogether) {
  // Thirty seeds that all end alike are no more than one: the same leads as above.
  const auto chance = chance_of_best({{30, 0}, {30, 0}, {30, 0}}, 90);
  ASSERT_TRUE(chance.has_value());
  EXPECT_DOUBLE_EQ(chance->lead, 0.5);
  EXPECT_NEAR(chance->expected, 0.25, 0.02);
  EXPECT_DOUBLE_EQ(chance->high, 0.5);
}

TEST(ChanceOfBest, OfEqualSettingsIsSeldomBeyondChance) {
  // Settings that are right at each of 50 places with the same probability: 5 % of such sweeps lead by more
  // than `high`.
  Rng rng(3);
  int beyond = 0;
  constexpr int sweeps = 300;
  double lead = 0.0;
  double expected = 0.0;
  for (int k = 0; k < sweeps; ++k) {
    std::vector<ScoresAtPlace> places(50, ScoresAtPlace(10));
    for (ScoresAtPlace& scores : places) {
      const double p = rng.uniform();
      for (int& score : scores) score = rng.uniform() < p ? 1 : 0;
    }
    const auto chance = chance_of_best(places, places.size());
    ASSERT_TRUE(chance.has_value());
    beyond += chance->lead > chance->high ? 1 : 0;
    lead += chance->lead / sweeps;
    expected += chance->expected / sweeps;
  }
  EXPECT_LE(beyond, 30);
  EXPECT_NEAR(lead, expected, 0.01);
}

TEST(ChanceOfBest, ARealLeadIsFound) {
  std::vector<ScoresAtPlace> places;
  for (int i = 0; i < 40; ++i) places.push_back({1, 0, i % 2, 0});
  const auto chance = chance_of_best(places, places.size());
  ASSERT_TRUE(chance.has_value());
  EXPECT_GT(chance->lead, chance->high);
  EXPECT_LT(chance->share, 0.01);
}

TEST(ChanceOfBest, ThereIsNoneOfOneSetting) {
  EXPECT_FALSE(chance_of_best({}, 0).has_value());
  EXPECT_FALSE(chance_of_best({{1}, {0}}, 2).has_value());
}

}  // namespace
}  // namespace glocal::test::chance_test
