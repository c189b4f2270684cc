#include "matchers/indexed_ransam/oriented_pair_index.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include "glocal/pose2.hpp"
#include "glocal/rng.hpp"

namespace glocal::indexed_ransam::oriented_pair_index_test {
namespace {

constexpr double pi = std::numbers::pi;

OrientedPoints scattered(int n, double side) {
  Rng rng(11);
  OrientedPoints oriented_points;
  for (int i = 0; i < n; ++i) {
    oriented_points.add(static_cast<float>(rng.uniform(0.0, side)),
                        static_cast<float>(rng.uniform(0.0, side)), static_cast<float>(rng.uniform(-pi, pi)));
  }
  return oriented_points;
}

OrientedPoints moved(const OrientedPoints& oriented_points, const Pose2& pose) {
  OrientedPoints result;
  for (std::size_t i = 0; i < oriented_points.size(); ++i) {
    const Pose2 p = pose * Pose2{oriented_points.x[i], oriented_points.y[i], oriented_points.angle[i]};
    result.add(static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.theta));
  }
  return result;
}

std::set<std::pair<std::uint32_t, std::uint32_t>> pairs(
    std::span<const OrientedPairIndex::OrientedPair> pairs) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> result;
  for (const auto& d : pairs) result.emplace(d.first, d.second);
  return result;
}

/// Length, and both angles, as told by geometry.
struct Seen {
  double length, first, second;
};
Seen seen(const OrientedPoints& s, std::uint32_t a, std::uint32_t b) {
  const double dx = s.x[b] - s.x[a];
  const double dy = s.y[b] - s.y[a];
  const double direction = std::atan2(dy, dx);
  return {std::hypot(dx, dy), wrap_angle(s.angle[a] - direction), wrap_angle(s.angle[b] - direction)};
}

TEST(OrientedPairIndex, HoldsEveryOrderedPairInRange) {
  const OrientedPoints oriented_points = scattered(200, 12.0);
  std::size_t expected = 0;
  for (std::uint32_t a = 0; a < 200; ++a) {
    for (std::uint32_t b = 0; b < 200; ++b) {
      const double length = std::hypot(double{oriented_points.x[a]} - oriented_points.x[b],
                                       double{oriented_points.y[a]} - oriented_points.y[b]);
      if (a != b && length >= 0.5 && length < 6.0) ++expected;
    }
  }
  const OrientedPairIndex index(oriented_points, {});
  EXPECT_EQ(index.size(), expected);
  EXPECT_GE(index.memory_bytes(), 8 * expected);
}

TEST(OrientedPairIndex, APairFindsItselfWhereverItHasBeenMovedTo) {
  const OrientedPoints map = scattered(150, 10.0);
  const OrientedPairIndex index(map, {});
  const OrientedPoints local = moved(map, {3.0, -7.0, 1.234});
  int found = 0;
  int all = 0;
  for (std::uint32_t a = 0; a < 150; ++a) {
    for (std::uint32_t b = 0; b < 150; ++b) {
      const double length = seen(map, a, b).length;
      if (a == b || length < 0.6 || length > 5.9) continue;
      ++all;
      found += pairs(index.find(local, {a, b})).contains({a, b}) ? 1 : 0;
    }
  }
  // Rounding moves a few over a bin's edge.
  EXPECT_GT(found, 0.999 * all);
}

TEST(OrientedPairIndex, PartnersAreAlike) {
  const OrientedPoints map = scattered(150, 10.0);
  const OrientedPairIndex index(map, {});
  std::size_t partners = 0;
  for (std::uint32_t a = 0; a < 150; a += 3) {
    for (std::uint32_t b = 0; b < 150; b += 5) {
      for (const auto& d : index.find(map, {a, b})) {
        const Seen one = seen(map, a, b);
        const Seen other = seen(map, d.first, d.second);
        EXPECT_LT(std::abs(one.length - other.length), 0.1 + 1e-5);
        EXPECT_LT(std::abs(wrap_angle(one.first - other.first)), radians(15.0) + 1e-5);
        EXPECT_LT(std::abs(wrap_angle(one.second - other.second)), radians(15.0) + 1e-5);
        ++partners;
      }
    }
  }
  EXPECT_GT(partners, 500U);
}

TEST(OrientedPairIndex, OfTooManyAnEvenShareIsKeptTheSameEachTime) {
  const OrientedPoints oriented_points = scattered(400, 10.0);
  OrientedPairRule rule;
  const std::size_t all = OrientedPairIndex(oriented_points, rule).size();
  rule.max_entries = 10'000;
  ASSERT_GT(all, 3 * rule.max_entries);
  const OrientedPairIndex one(oriented_points, rule);
  const OrientedPairIndex other(oriented_points, rule);
  EXPECT_NEAR(static_cast<double>(one.size()), 10'000.0, 500.0);
  EXPECT_EQ(one.size(), other.size());
  std::size_t from_first_half = 0;
  for (std::uint32_t a = 0; a < 400; ++a) {
    for (std::uint32_t b = 0; b < 400; ++b) {
      const auto found = pairs(one.find(oriented_points, {a, b}));
      EXPECT_EQ(found, pairs(other.find(oriented_points, {a, b})));
      if (found.contains({a, b}) && a < 200) ++from_first_half;
    }
  }
  EXPECT_NEAR(static_cast<double>(from_first_half) / static_cast<double>(one.size()), 0.5, 0.05);
}

TEST(OrientedPairIndex, IsTheSameForAnyNumberOfThreads) {
  const OrientedPoints oriented_points = scattered(500, 15.0);
  const OrientedPairRule rule{.max_entries = 20'000};
  const auto all_found = [&](int threads) {
    const OrientedPairIndex index(oriented_points, rule, threads);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> all;
    for (std::uint32_t a = 0; a < 500; ++a) {
      for (std::uint32_t b = 0; b < 500; ++b) {
        for (const auto& pair : index.find(oriented_points, {a, b}))
          all.emplace_back(pair.first, pair.second);
      }
    }
    return all;
  };
  const auto one = all_found(1);
  EXPECT_GT(one.size(), 19'000U);
  EXPECT_EQ(one, all_found(2));
  EXPECT_EQ(one, all_found(5));
}

TEST(OrientedPairIndex, ShortAndLongOnesHaveNoPartnersAndNothingIsAnAnswer) {
  OrientedPoints two;
  two.add(0.0F, 0.0F, 0.0F);
  two.add(0.3F, 0.0F, 0.0F);
  two.add(9.0F, 0.0F, 0.0F);
  const OrientedPairIndex index(two, {});
  EXPECT_TRUE(index.find(two, {0, 1}).empty());
  EXPECT_TRUE(index.find(two, {0, 2}).empty());
  EXPECT_TRUE(index.find(two, {0, 0}).empty());
  EXPECT_EQ(OrientedPairIndex({}, {}).size(), 0U);
}

}  // namespace
}  // namespace glocal::indexed_ransam::oriented_pair_index_test
