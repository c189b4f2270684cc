// How far settings are ahead, against ways to give signs counted by hand.
#include "evaluation/sweeps/leads.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "glocal/rng.hpp"

namespace glocal::test::leads_test {
namespace {

/// Settings at places: with the numbers of each place as scores.
std::vector<ScoresAtPlace> repeated(const ScoresAtPlace& scores, std::size_t places) {
  return std::vector<ScoresAtPlace>(places, scores);
}

TEST(Lead, CountsPlacesAndIsTestedBySigns) {
  std::vector<ScoresAtPlace> places = repeated({1, 0}, 7);
  places.push_back({0, 3});
  places.push_back({1, 1});
  const Lead lead = lead_of(0, 1, places);
  EXPECT_EQ(lead.score, 4);
  EXPECT_EQ(lead.places_better, 7U);
  EXPECT_EQ(lead.places_worse, 1U);
  // Of 2^8 ways: with 3, the seven ones need a sum of 1 or more (64 ways), or of 7 without it (1 way), twice.
  EXPECT_DOUBLE_EQ(lead.p, 2.0 * 65.0 / 256.0);
  EXPECT_EQ(lead_of(1, 0, places).score, -4);
}

TEST(Leads, OfOneThatCanBeFoundAreExact) {
  // The second differs at 9 places, the third at 2, where no test finds anything.
  std::vector<ScoresAtPlace> places = repeated({1, 0, 1}, 9);
  places.push_back({1, 1, 0});
  places.push_back({1, 1, 0});
  const std::vector<Lead> leads = leads_over(0, places);
  ASSERT_EQ(leads.size(), 3U);
  EXPECT_EQ(leads[0].p, 1.0);
  EXPECT_DOUBLE_EQ(leads[1].p, 2.0 / 512.0);
  EXPECT_DOUBLE_EQ(leads[2].p, 0.5);
}

TEST(Leads, PayForTheChoiceOfMany) {
  // Ten settings, each ahead at 8 places of its own and behind at one: by itself 2 * 10 / 2^9.
  std::vector<ScoresAtPlace> places;
  for (std::size_t s = 1; s <= 10; ++s) {
    for (int i = 0; i < 9; ++i) {
      places.emplace_back(11, 0);
      places.back()[s] = i < 8 ? 1 : -1;
    }
  }
  const std::vector<Lead> leads = leads_over(0, places);
  const double alone = 20.0 / 512.0;
  EXPECT_DOUBLE_EQ(lead_of(1, 0, places).p, alone);
  // They are independent: 1 - (1 - alone)^10 = 0.328; 5000 resamples know it to 0.007.
  EXPECT_NEAR(leads[1].p, 1.0 - std::pow(1.0 - alone, 10.0), 0.025);
}

TEST(Leads, SettingsThatAreAlikeCountOnce) {
  const std::vector<Lead> leads = leads_over(0, repeated({0, 1, 1, 1, 1}, 8));
  EXPECT_NEAR(leads[1].p, 2.0 / 256.0, 0.005);
  EXPECT_GE(leads[1].p, 2.0 / 256.0);
}

TEST(Leads, OfEqualSettingsAreFoundInAboutOneOfTwentySweeps) {
  Rng rng(17);
  int found = 0;
  constexpr int sweeps = 300;
  for (int k = 0; k < sweeps; ++k) {
    std::vector<ScoresAtPlace> places;
    for (int i = 0; i < 40; ++i) {
      places.emplace_back();
      for (int s = 0; s < 6; ++s) places.back().push_back(rng.uniform() < 0.8 ? 1 : 0);
    }
    const std::vector<Lead> leads = leads_over(0, places);
    found += std::any_of(leads.begin(), leads.end(), [](const Lead& lead) { return lead.p < 0.05; }) ? 1 : 0;
  }
  // 5 % of 300 is 15, with a standard deviation of 3.8.
  EXPECT_LE(found, 25);
  EXPECT_GE(found, 3);
}

TEST(Leads, AreTheSameEveryTime) {
  const std::vector<ScoresAtPlace> places = repeated({0, 1, 1, -1}, 12);
  EXPECT_EQ(leads_over(0, places)[3].p, leads_over(0, places)[3].p);
  EXPECT_TRUE(leads_over(0, {}).empty());
}

}  // namespace
}  // namespace glocal::test::leads_test
