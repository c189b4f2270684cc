#include "matchers/triple_sampler.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "test_world.hpp"

namespace glocal {
namespace {

TEST(TripleSampler, DrawsAreRepeatable) {
  const Points points = testing::small_world_points();
  const TripleSampler sampler(points, 0.0);
  EXPECT_EQ(sampler.draw(5, 77), sampler.draw(5, 77));
  EXPECT_NE(sampler.draw(5, 77), sampler.draw(5, 78));
  EXPECT_NE(sampler.draw(5, 77), sampler.draw(6, 77));
}

TEST(TripleSampler, UniformDrawsTakeEveryPointAsOften) {
  Points points;
  for (int i = 0; i < 10; ++i) points.push_back({static_cast<float>(i), 0.0F, 0.0F});
  const TripleSampler sampler(points, 0.0);
  std::vector<int> counts(10, 0);
  for (std::uint64_t n = 0; n < 20000; ++n) {
    const auto triple = sampler.draw(1, n);
    ASSERT_TRUE(triple);
    for (const std::uint32_t i : *triple) ++counts.at(i);
  }
  double chi_square = 0.0;
  for (const int count : counts) chi_square += (count - 6000.0) * (count - 6000.0) / 6000.0;
  EXPECT_LT(chi_square, 27.88);  // 9 degrees of freedom, p = 0.001
}

TEST(TripleSampler, LocalDrawsStayWithinTheRadiusAndReachEveryNeighbour) {
  const Points points = testing::small_world_points();
  constexpr double radius = 1.0;
  const TripleSampler sampler(points, radius);
  const auto near = [&](std::uint32_t a, std::uint32_t b) {
    return std::hypot(points.x[a] - points.x[b], points.y[a] - points.y[b]) <= radius + 1e-5;
  };
  std::vector<bool> reached(points.size(), false);
  std::size_t drawn = 0;
  for (std::uint64_t n = 0; n < 40000; ++n) {
    const auto triple = sampler.draw(9, n);
    if (!triple) continue;
    ++drawn;
    ASSERT_TRUE(near((*triple)[0], (*triple)[1]) && near((*triple)[0], (*triple)[2]));
    reached[(*triple)[1]] = true;
    reached[(*triple)[2]] = true;
  }
  EXPECT_GT(drawn, 39000U);
  EXPECT_EQ(std::count(reached.begin(), reached.end(), false), 0);
}

TEST(TripleSampler, ALonelyPointIsItsOnlyNeighbour) {
  Points points;
  points.push_back({0.0F, 0.0F, 0.0F});
  points.push_back({50.0F, 50.0F, 0.0F});
  const TripleSampler sampler(points, 1.0);
  const auto triple = sampler.draw(1, 0);
  ASSERT_TRUE(triple);
  EXPECT_EQ((*triple)[0], (*triple)[1]);
  EXPECT_EQ((*triple)[0], (*triple)[2]);
}

}  // namespace
}  // namespace glocal
