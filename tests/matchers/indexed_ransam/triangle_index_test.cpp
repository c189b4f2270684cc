#include "matchers/indexed_ransam/triangle_index.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "bench/plain.hpp"
#include "glocal/rng.hpp"
#include "test_world.hpp"

namespace glocal::indexed_ransam::triangle_index_test {
namespace {

constexpr std::size_t no_limit = 100'000'000;

Points scattered(int n, double side) {
  Rng rng(5);
  Points points;
  for (int i = 0; i < n; ++i) {
    points.push_back(
        {static_cast<float>(rng.uniform(0.0, side)), static_cast<float>(rng.uniform(0.0, side)), 0.0F});
  }
  return points;
}

Triple sorted(Triple triple) {
  std::sort(triple.begin(), triple.end());
  return triple;
}

/// All triangles of the points by their relation, found one by one.
std::map<Relation, std::set<Triple>> all_triangles(const Points& points, const TriangleRule& rule) {
  std::map<Relation, std::set<Triple>> result;
  const auto n = static_cast<std::uint32_t>(points.size());
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = i + 1; j < n; ++j) {
      for (std::uint32_t k = j + 1; k < n; ++k) {
        if (const auto t = plain::canonical_triangle(points, {i, j, k}, rule)) {
          result[t->relation].insert({i, j, k});
        }
      }
    }
  }
  return result;
}

TEST(TriangleIndex, HoldsEachAdmittedTriangleOnceUnderItsRelation) {
  const Points points = scattered(70, 9.0);
  const TriangleRule rule{.cell = 0.4, .min_side = 0.5, .min_height = 0.3, .max_side = 5.0};
  const auto expected = all_triangles(points, rule);
  std::size_t triangles = 0;
  const TriangleIndex index(points, rule, no_limit);
  for (const auto& [relation, of_relation] : expected) {
    const auto found = index.find(relation);
    std::set<Triple> distinct;
    for (const Triple& t : found) distinct.insert(sorted(t));
    EXPECT_EQ(distinct, of_relation);
    EXPECT_EQ(found.size(), of_relation.size());
    triangles += of_relation.size();
    EXPECT_EQ(index.find(relation + 1).empty(), !expected.contains(relation + 1));
  }
  EXPECT_EQ(index.size(), triangles);
  EXPECT_GT(triangles, 5'000U);
  EXPECT_GE(index.memory_bytes(), 12 * triangles);
  EXPECT_TRUE(index.find(0).empty());
  EXPECT_TRUE(index.find(std::numeric_limits<Relation>::max()).empty());
}

TEST(TriangleIndex, APartnerLiesWithinACellOfTheTriangleLaidOnIt) {
  // Sides differ by less than a cell, so no corner is off by more, as long as triangles are not flat.
  const TriangleRule rule{.cell = 0.1, .min_side = 2.3, .min_height = 2.0, .max_side = 3.0};
  const Points map = scattered(300, 8.0);
  const TriangleIndex index(map, rule, no_limit);
  const Points local = test::moved(map, {3.0, -7.0, 1.234});
  Rng rng(2);
  std::size_t partners = 0;
  while (partners < 2000) {
    const Triple drawn = plain::draw(local, rng);
    const auto triangle = plain::canonical_triangle(local, drawn, rule);
    if (!triangle) continue;
    for (const Triple& partner : index.find(triangle->relation)) {
      TripleBatch from;
      TripleBatch to;
      from.add(drawn);
      to.add(partner);
      MotionBatch motions;
      least_squares_motions(local, from, map, to, motions);
      for (const std::uint32_t i : drawn) {
        const Point p = motions[0](local[i]);
        double nearest = std::numeric_limits<double>::infinity();
        for (const std::uint32_t k : partner) {
          nearest = std::min(nearest, std::hypot(double{p.x} - map.x[k], double{p.y} - map.y[k]));
        }
        EXPECT_LT(nearest, 0.1);
      }
      ++partners;
    }
  }
}

TEST(TriangleIndex, ATriangleFindsItselfWhereverItHasBeenMovedTo) {
  const TriangleRule rule{.cell = 0.1, .min_side = 0.5, .min_height = 0.3, .max_side = 4.0};
  const Points map = scattered(60, 8.0);
  const TriangleIndex index(map, rule, no_limit);
  const Points local = test::moved(map, {3.0, -7.0, 1.234});
  int all = 0;
  int found = 0;
  for (const auto& [relation, triangles] : all_triangles(local, rule)) {
    for (const Triple& triangle : triangles) {
      const auto partners = index.find(relation);
      ++all;
      found += std::any_of(partners.begin(), partners.end(),
                           [&](const Triple& t) { return sorted(t) == triangle; })
                   ? 1
                   : 0;
    }
  }
  // Rounding moves a few over a cell's edge.
  EXPECT_GT(all, 1'000);
  EXPECT_GT(found, 0.999 * all);
}

TEST(TriangleIndex, OfTooManyAnEvenShareIsKeptTheSameForAnyNumberOfThreads) {
  const TriangleRule rule{.cell = 0.2, .min_side = 0.5, .min_height = 0.3, .max_side = 5.0};
  const Points points = scattered(200, 9.0);
  const std::size_t all = TriangleIndex(points, rule, no_limit).size();
  // Candidates that are too long or too flat take part in the draw, so somewhat fewer are kept.
  constexpr std::size_t most = 20'000;
  const TriangleIndex one(points, rule, most);
  ASSERT_GT(all, 5 * most);
  EXPECT_LE(one.size(), most);
  EXPECT_GT(one.size(), most / 2);
  for (const int threads : {2, 5}) {
    const TriangleIndex other(points, rule, most, threads);
    EXPECT_EQ(other.size(), one.size());
    for (const auto& [relation, triangles] : all_triangles(points, rule))
      EXPECT_TRUE(std::ranges::equal(one.find(relation), other.find(relation)));
  }
  // Each kind of triangle keeps the same share: compare those with a long and with a short longest side.
  std::size_t kept_long = 0;
  std::size_t all_long = 0;
  for (const auto& [relation, triangles] : all_triangles(points, rule)) {
    if (relation >> (2 * relation_side_bits) < 20) continue;  // a longest side below 4 m
    all_long += triangles.size();
    kept_long += one.find(relation).size();
  }
  const double share = static_cast<double>(one.size()) / static_cast<double>(all);
  EXPECT_NEAR(static_cast<double>(kept_long) / static_cast<double>(all_long), share, 0.05 * share);
}

TEST(TriangleIndex, TooFewPointsHaveNoTriangle) {
  for (const int n : {0, 1, 2}) {
    const TriangleIndex index(scattered(n, 1.0), {}, 1000);
    EXPECT_EQ(index.size(), 0U);
    EXPECT_TRUE(index.find(1).empty());
  }
}

}  // namespace
}  // namespace glocal::indexed_ransam::triangle_index_test
