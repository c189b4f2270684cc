// Shares of trials: whole, even, and the same each time.
#include "evaluation/sharding/shares.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <numeric>

namespace glocal::test::shares_test {
namespace {

using testing::ElementsAre;

using Steps = std::vector<std::vector<std::size_t>>;

std::size_t steps_of(const std::vector<PlannedTrial>& share, const Steps& steps) {
  return std::accumulate(
      share.begin(), share.end(), std::size_t{0},
      [&](std::size_t sum, const PlannedTrial& place) { return sum + steps[place.variant][place.trial]; });
}

/// Trials of many lengths, as numbers that no rule has chosen.
Steps uneven_steps(std::size_t variants, std::size_t trials) {
  Steps steps(variants, std::vector<std::size_t>(trials));
  std::size_t x = 1;
  for (auto& list : steps) {
    for (std::size_t& n : list) {
      x = x * 48271 % 2147483647;
      n = 1 + x % 60;
    }
  }
  return steps;
}

TEST(Shares, TheLongestTrialGoesToWhoHasTheLeast) {
  // By hand: 9 to the first, 7 to the second, 5 to the second (12), 4 to the first (13), 1 to the second.
  const Steps steps = {{4, 9, 5, 1, 7}};
  EXPECT_THAT(share_of(steps, {1, 2}), ElementsAre(PlannedTrial{0, 0}, PlannedTrial{0, 1}));
  EXPECT_THAT(share_of(steps, {2, 2}),
              ElementsAre(PlannedTrial{0, 2}, PlannedTrial{0, 3}, PlannedTrial{0, 4}));
}

TEST(Shares, EachTrialIsInOne) {
  for (const std::size_t shards : {1U, 2U, 3U, 7U, 64U, 500U}) {
    const Steps steps = uneven_steps(5, 40);
    std::map<std::pair<std::size_t, std::size_t>, int> times;
    for (std::size_t k = 1; k <= shards; ++k) {
      for (const PlannedTrial& place : share_of(steps, {k, shards})) ++times[{place.variant, place.trial}];
    }
    EXPECT_EQ(times.size(), 200U);
    EXPECT_TRUE(std::all_of(times.begin(), times.end(), [](const auto& t) { return t.second == 1; }));
  }
}

TEST(Shares, AreEvenInAllAndInEachVariant) {
  const Steps steps = uneven_steps(6, 50);
  constexpr std::size_t shards = 8;
  constexpr std::size_t longest = 60;
  std::vector<std::size_t> in_all;
  for (std::size_t variant = 0; variant < steps.size(); ++variant) {
    std::vector<std::size_t> sums;
    for (std::size_t k = 1; k <= shards; ++k) {
      auto share = share_of(steps, {k, shards});
      if (variant == 0) in_all.push_back(steps_of(share, steps));
      std::erase_if(share, [&](const PlannedTrial& place) { return place.variant != variant; });
      sums.push_back(steps_of(share, steps));
    }
    const auto [least, most] = std::minmax_element(sums.begin(), sums.end());
    EXPECT_LE(*most - *least, longest) << variant;
  }
  const auto [least, most] = std::minmax_element(in_all.begin(), in_all.end());
  EXPECT_LE(*most - *least, longest);
}

TEST(Shares, FewTrialsOfManyVariantsGoToAllShards) {
  const Steps steps(30, {10, 10});
  for (std::size_t k = 1; k <= 20; ++k) EXPECT_EQ(share_of(steps, {k, 20}).size(), 3U) << k;
}

TEST(Shares, OfNoTrialsAreEmpty) {
  EXPECT_TRUE(share_of({}, {1, 3}).empty());
  EXPECT_TRUE(share_of({{}, {}}, {3, 3}).empty());
}

}  // namespace
}  // namespace glocal::test::shares_test
