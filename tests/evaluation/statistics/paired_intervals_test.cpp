#include "evaluation/statistics/paired_intervals.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "evaluation/statistics/statistics.hpp"

namespace glocal::paired_intervals_test {
namespace {

constexpr double z = 1.959964;

/// Places of one trial: so many pairs in which only the first, only the second, and both or neither have it.
std::vector<PlaceOutcomes> pairs(std::size_t first, std::size_t second, std::size_t same) {
  std::vector<PlaceOutcomes> places(first, {0, 1, 1, 0});
  places.resize(first + second, {0, 1, 0, 1});
  places.resize(first + second + same, {0, 1, 0, 0});
  return places;
}

TEST(IntervalOfShares, OfPairsFollowsFromItsFormula) {
  // 1 and 7 of 21 pairs differ; one more each way makes it 2 and 8 of 23.
  const Interval interval = interval_of_shares(pairs(1, 7, 13));
  EXPECT_NEAR(interval.low, 6.0 / 23.0 - z * std::sqrt((10.0 / 23.0 - 36.0 / 529.0) / 23.0), 1e-6);
  EXPECT_NEAR(interval.high, 0.5084, 1e-4);
  EXPECT_NEAR(interval.low, 0.0134, 1e-4);
}

TEST(IntervalOfShares, SwappingTheTwoTurnsItRound) {
  const Interval one = interval_of_shares(pairs(7, 3, 32));
  const Interval other = interval_of_shares(pairs(3, 7, 32));
  EXPECT_DOUBLE_EQ(one.low, -other.high);
  EXPECT_DOUBLE_EQ(one.high, -other.low);
}

TEST(IntervalOfShares, SaysSomethingWhereNoPairDiffers) {
  const Interval interval = interval_of_shares(pairs(0, 0, 20));
  EXPECT_NEAR(interval.high, z * std::sqrt(2.0 / 22.0 / 22.0), 1e-6);
  EXPECT_DOUBLE_EQ(interval.low, -interval.high);
  EXPECT_EQ(interval_of_shares({}).low, -1.0);
  EXPECT_EQ(interval_of_shares({}).high, 1.0);
  // Three seeds of a place tell no more than one, as long as nothing differs.
  EXPECT_DOUBLE_EQ(interval_of_shares(std::vector<PlaceOutcomes>(20, {0, 3, 0, 0})).high, interval.high);
}

TEST(IntervalOfShares, SeedsThatAllEndAlikeTellNoMoreThanOne) {
  const Interval one = interval_of_shares(pairs(2, 6, 34));
  std::vector<PlaceOutcomes> thrice;
  for (const PlaceOutcomes& p : pairs(2, 6, 34))
    thrice.push_back({0, 3, 3 * p.only_first, 3 * p.only_second});
  // But for the estimate of the variance, of n - 1 places.
  EXPECT_NEAR(interval_of_shares(thrice).low, one.low, 0.003);
  EXPECT_NEAR(interval_of_shares(thrice).high, one.high, 0.003);
}

TEST(IntervalOfShares, PlacesOfManyTrialsTellNoMoreThanThoseOfOne) {
  // 6 of 40 places of four trials differ, of 80 of a single one none. The mean is 0.1, and the variance of
  // the sum (6 * 3.6^2 + 34 * 0.4^2 - 8^2 / 40) * 40 / 39; each pair by itself would make it 21.6.
  std::vector<PlaceOutcomes> places(6, {0, 4, 0, 4});
  places.resize(40, {0, 4, 0, 0});
  places.resize(120, {1, 1, 0, 0});
  const Interval interval = interval_of_shares(places);
  EXPECT_GT(interval.high - interval.low, 2.0 * z * std::sqrt(81.6 * 40.0 / 39.0) / 240.0);
}

TEST(IntervalOfShares, CasesThatDifferAreNoChance) {
  // In one case all are better, in the other one none: another sample has the same of each.
  std::vector<PlaceOutcomes> places(20, {0, 2, 0, 2});
  places.resize(40, {1, 2, 0, 0});
  const Interval by_case = interval_of_shares(places);
  for (PlaceOutcomes& place : places) place.stratum = 0;
  const Interval pooled = interval_of_shares(places);
  EXPECT_LT(by_case.high - by_case.low, 0.8 * (pooled.high - pooled.low));
}

double normal_interval(double mean, double variance_of_sum, double trials) {
  return mean + z * std::sqrt(variance_of_sum) / trials;
}

TEST(IntervalOfMean, OfManyPlacesIsItsStandardError) {
  Rng rng(5);
  std::vector<PlaceSum> places;
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < 400; ++i) {
    places.push_back({0, 2, 2.0 * (3.0 + rng.normal(2.0))});
    sum += places.back().sum;
  }
  const double mean = sum / 800.0;
  for (const PlaceSum& place : places) squares += (place.sum - 2.0 * mean) * (place.sum - 2.0 * mean);
  const Interval interval = interval_of_mean(places, Rng(1));
  const double high = normal_interval(mean, squares, 800.0);
  EXPECT_NEAR(interval.high, high, 0.1 * (high - mean));
  EXPECT_NEAR(interval.low, 2.0 * mean - high, 0.1 * (high - mean));
}

TEST(IntervalOfMean, HasNoWidthWhereAllPlacesAreTheSame) {
  const Interval interval = interval_of_mean(std::vector<PlaceSum>(20, {0, 3, -6.0}), Rng(1));
  EXPECT_EQ(interval.low, -2.0);
  EXPECT_EQ(interval.high, -2.0);
}

TEST(IntervalOfMean, OfFewPlacesIsAtLeastStudents) {
  // Two places with 0 and 1: mean 1/2, error 1/2, and 12.706 is Student's quantile with one degree of
  // freedom.
  const Interval interval = interval_of_mean({{0, 1, 0.0}, {0, 1, 1.0}}, Rng(1));
  EXPECT_NEAR(interval.low, 0.5 - 12.7062 * 0.5, 1e-4);
  EXPECT_NEAR(interval.high, 0.5 + 12.7062 * 0.5, 1e-4);
}

TEST(IntervalOfMean, LeansToTheLongTail) {
  Rng rng(7);
  std::vector<PlaceSum> places;
  double sum = 0.0;
  for (int i = 0; i < 30; ++i) {
    places.push_back({0, 1, -std::log(1.0 - rng.uniform())});
    sum += places.back().sum;
  }
  const Interval interval = interval_of_mean(places, Rng(1));
  EXPECT_GT(interval.high - sum / 30.0, 1.1 * (sum / 30.0 - interval.low));
}

TEST(IntervalOfMean, FollowsFromItsRandomNumbers) {
  Rng rng(3);
  std::vector<PlaceSum> places;
  for (int i = 0; i < 50; ++i) places.push_back({0, 1, rng.uniform() * rng.uniform()});
  const auto high = [&](std::uint64_t seed) { return interval_of_mean(places, Rng(seed)).high; };
  EXPECT_EQ(high(1), high(1));
  EXPECT_NE(high(1), high(2));
}

TEST(PlacesToFind, FollowFromTheWidthOfAnInterval) {
  // A standard error of 1 from 100 places; a difference of 2.8016 (z of 0.975 and of 0.8) takes as many, half
  // of it four times as many.
  EXPECT_NEAR(places_to_find(2.801585, 100, {-z, z}), 100.0, 1.0);
  EXPECT_NEAR(places_to_find(2.801585 / 2.0, 100, {-z, z}), 400.0, 1.0);
}

}  // namespace
}  // namespace glocal::paired_intervals_test
