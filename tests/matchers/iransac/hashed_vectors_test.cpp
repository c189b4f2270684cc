#include "matchers/iransac/hashed_vectors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "matchers/iransac/feature_index.hpp"

namespace glocal::iransac::hashed_vectors_test {
namespace {

constexpr std::size_t dimensions = 20;

/// Pairs of vectors at a given distance: vector i of the second set is that far from vector i of the first.
struct Pairs {
  FeatureVectors first{dimensions, {}};
  FeatureVectors second{dimensions, {}};

  Pairs(std::size_t n, double distance, Rng& rng) {
    for (std::size_t i = 0; i < n; ++i) {
      std::vector<double> direction;
      double length = 0.0;
      for (std::size_t d = 0; d < dimensions; ++d) {
        direction.push_back(rng.normal(1.0));
        length += direction.back() * direction.back();
      }
      for (const double part : direction) {
        const double start = rng.uniform(-50.0, 50.0);  // far from all other pairs
        first.values.push_back(static_cast<float>(start));
        second.values.push_back(static_cast<float>(start + distance * part / std::sqrt(length)));
      }
    }
  }
};

/// p(c) of one projection (Datar et al. 2004, section 3.2): its integral by the midpoint rule.
double collision_probability(double distance, double width) {
  constexpr int steps = 100000;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double t = width * (i + 0.5) / steps;
    const double u = t / distance;
    const double density = std::sqrt(2.0 / std::numbers::pi) * std::exp(-u * u / 2.0);  // of |normal|
    sum += density / distance * (1.0 - t / width) * width / steps;
  }
  return sum;
}

TEST(HashedVectors, FindsANearVectorAsOftenAsPublished) {
  constexpr std::size_t pairs = 400;
  constexpr int repetitions = 20;  // with other hash functions: those of one are shared by all pairs
  for (const double distance : {0.3, 0.8, 1.5}) {
    const HashRule rule{.tables = 5, .projections = 4, .bucket_width = 1.5};
    std::size_t found = 0;
    for (int i = 0; i < repetitions; ++i) {
      Rng rng(static_cast<std::uint64_t>(100 + i));
      const Pairs p(pairs, distance, rng);
      const HashedVectors hashed(p.first, rule, rng);
      for (std::size_t k = 0; k < pairs; ++k) {
        const auto near = hashed.find(p.second[k]);
        found += std::binary_search(near.begin(), near.end(), static_cast<std::uint32_t>(k)) ? 1 : 0;
      }
    }
    const double n = static_cast<double>(pairs) * repetitions;
    const double in_one = std::pow(collision_probability(distance, rule.bucket_width), rule.projections);
    const double expected = 1.0 - std::pow(1.0 - in_one, rule.tables);
    // Directions of the pairs differ, hash functions are new each time: four standard deviations.
    EXPECT_NEAR(static_cast<double>(found) / n, expected, 4.0 * std::sqrt(expected * (1.0 - expected) / n))
        << distance;
  }
}

TEST(HashedVectors, NeverReturnsWhatSharesNoBucket) {
  // With one table and one projection a bucket is a slab as wide as bucket_width times the direction's
  // length: what is much farther along every direction shares none.
  FeatureVectors vectors{2, {0.0F, 0.0F, 1000.0F, 1000.0F, 1e-4F, 0.0F}};
  const HashedVectors hashed(vectors, {.tables = 10, .projections = 4, .bucket_width = 1.0}, Rng(1));
  const std::vector<float> query{0.0F, 0.0F};
  EXPECT_EQ(hashed.find(query.data()), (std::vector<std::uint32_t>{0, 2}));
  const std::vector<float> elsewhere{-500.0F, 300.0F};
  EXPECT_TRUE(hashed.find(elsewhere.data()).empty());
}

/// The nearest among what is hashed alike are some of the nearest of all, in the same order.
TEST(FeatureIndex, HashingOnlyLeavesFeaturesOut) {
  Rng rng(5);
  OrientedPoints oriented_points;
  for (int i = 0; i < 300; ++i) {
    oriented_points.add(static_cast<float>(rng.uniform(0.0, 9.0)), static_cast<float>(rng.uniform(0.0, 9.0)),
                        static_cast<float>(rng.uniform(-3.0, 3.0)));
  }
  const FeatureIndex all(oriented_points, {}, std::nullopt, 1);
  const FeatureIndex hashed(oriented_points, {}, HashRule{}, 1);
  const FeatureVectors features = shape_contexts(oriented_points, {7, 70}, {});
  for (std::size_t i = 0; i < features.size(); ++i) {
    const auto exact = all.nearest(features[i], 300);
    ASSERT_EQ(exact.size(), 300U);
    EXPECT_EQ(exact.front(), i == 0 ? 7U : 70U);  // itself
    for (std::size_t k = 1; k < exact.size(); ++k) {
      const FeatureVectors two = shape_contexts(oriented_points, {exact[k - 1], exact[k]}, {});
      EXPECT_LE(squared_distance(features[i], two[0], two.dimensions),
                squared_distance(features[i], two[1], two.dimensions) + 1e-5F);
    }
    const auto some = hashed.nearest(features[i], 300);
    EXPECT_LT(some.size(), exact.size());
    auto place = exact.begin();
    for (const std::uint32_t number : some) {
      place = std::find(place, exact.end(), number);
      ASSERT_NE(place, exact.end());
    }
  }
}

}  // namespace
}  // namespace glocal::iransac::hashed_vectors_test
