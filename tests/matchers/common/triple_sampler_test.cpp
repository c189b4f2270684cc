#include "matchers/common/triple_sampler.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "instruction_sets.hpp"
#include "points.hpp"
#include "test_world.hpp"

namespace glocal::triple_sampler_test {
namespace {

/// Draws [begin, end) of a seed, in batches of at most `per_batch`.
std::vector<Triple> draws(const TripleSampler& sampler, std::uint64_t seed, std::uint32_t begin,
                          std::uint32_t end, std::size_t per_batch = TripleBatch::capacity) {
  std::vector<Triple> result;
  TripleBatch batch;
  while (begin < end) {
    batch.clear();
    while (begin < end && batch.size < per_batch) batch.add_number(begin++);
    sampler.draw(seed, batch);
    for (std::size_t i = 0; i < batch.size; ++i)
      result.push_back({batch.first[i], batch.second[i], batch.third[i]});
  }
  return result;
}

TEST(TripleSampler, ADrawDependsOnItsSeedAndNumberOnly) {
  const Points points = test::small_world_points();
  for (const double local_radius : {0.0, 1.0}) {
    const TripleSampler sampler(points, local_radius);
    const std::vector<Triple> expected = draws(sampler, 5, 0, 1000);
    EXPECT_EQ(draws(sampler, 5, 0, 1000, 7), expected);
    EXPECT_EQ(draws(sampler, 5, 77, 78).front(), expected[77]);
    EXPECT_NE(draws(sampler, 6, 0, 1000), expected);
  }
}

TEST(TripleSampler, CellsDoNotGetSmallerAndSmallerWithTheRadius) {
  // As many cells as the radius fits into would take more memory than there is.
  const Points points = test::small_world_points();
  for (const Triple& triple : draws(TripleSampler(points, 1e-9), 5, 0, 100))
    EXPECT_EQ(triple, (Triple{triple[0], triple[0], triple[0]}));
}

TEST(TripleSampler, UniformDrawsAreTheSameForEveryInstructionSet) {
  const Points points = test::small_world_points();
  const TripleSampler sampler(points, 0.0);
  const std::vector<Triple> expected = draws(sampler, 5, 0, 1000);
  test::with_every_instruction_set([&] { EXPECT_EQ(draws(sampler, 5, 0, 1000), expected); });
}

TEST(TripleSampler, PointsOfADrawAndOfTheNextDoNotDependOnEachOther) {
  // Which of 8 groups the points fall into: all pairs of groups must be equally frequent.
  const std::vector<Triple> triples = [] {
    Points points;
    for (int i = 0; i < 8000; ++i) points.push_back({static_cast<float>(i), 0.0F, 0.0F});
    return draws(TripleSampler(points, 0.0), 3, 0, 64000);
  }();
  const auto expect_independent = [&](auto first, auto second) {
    std::vector<double> counts(64, 0.0);
    for (std::size_t i = 0; i + 1 < triples.size(); ++i)
      counts[first(i) / 1000 * 8 + second(i) / 1000] += 1.0;
    const double mean = static_cast<double>(triples.size() - 1) / 64.0;
    double chi_square = 0.0;
    for (const double count : counts) chi_square += (count - mean) * (count - mean) / mean;
    EXPECT_LT(chi_square, 103.4);  // 63 degrees of freedom, p = 0.001
  };
  const auto point = [&](std::size_t corner, std::size_t ahead) {
    return [&triples, corner, ahead](std::size_t i) { return triples[i + ahead].at(corner); };
  };
  expect_independent(point(0, 0), point(1, 0));
  expect_independent(point(0, 0), point(2, 0));
  expect_independent(point(1, 0), point(2, 0));
  expect_independent(point(0, 0), point(0, 1));
  expect_independent(point(2, 0), point(0, 1));
}

TEST(TripleSampler, UniformDrawsTakeEveryPointAsOften) {
  Points points;
  for (int i = 0; i < 10; ++i) points.push_back({static_cast<float>(i), 0.0F, 0.0F});
  const TripleSampler sampler(points, 0.0);
  std::vector<int> counts(10, 0);
  for (const Triple& triple : draws(sampler, 1, 0, 20000)) {
    for (const std::uint32_t i : triple) ++counts.at(i);
  }
  double chi_square = 0.0;
  for (const int count : counts) chi_square += (count - 6000.0) * (count - 6000.0) / 6000.0;
  EXPECT_LT(chi_square, 27.88);  // 9 degrees of freedom, p = 0.001
}

TEST(TripleSampler, LocalDrawsStayWithinTheRadiusAndReachEveryNeighbour) {
  const Points points = test::small_world_points();
  constexpr double radius = 1.0;
  const TripleSampler sampler(points, radius);
  const auto near = [&](std::uint32_t a, std::uint32_t b) {
    return std::hypot(points.x[a] - points.x[b], points.y[a] - points.y[b]) <= radius + 1e-5;
  };
  std::vector<bool> reached(points.size(), false);
  std::size_t drawn = 0;
  for (const Triple& triple : draws(sampler, 9, 0, 40000)) {
    if (triple[0] == triple[1] && triple[0] == triple[2]) continue;
    ++drawn;
    ASSERT_TRUE(near(triple[0], triple[1]) && near(triple[0], triple[2]));
    reached[triple[1]] = true;
    reached[triple[2]] = true;
  }
  EXPECT_GT(drawn, 39000U);
  EXPECT_EQ(std::count(reached.begin(), reached.end(), false), 0);
}

TEST(TripleSampler, ALonelyPointIsItsOnlyNeighbour) {
  const Points points = test::points_of({{0.0F, 0.0F, 0.0F}, {50.0F, 50.0F, 0.0F}});
  const TripleSampler sampler(points, 1.0);
  const Triple triple = draws(sampler, 1, 0, 1).front();
  EXPECT_EQ(triple[0], triple[1]);
  EXPECT_EQ(triple[0], triple[2]);
}

}  // namespace
}  // namespace glocal::triple_sampler_test
