#include "glocal/voxel_filter.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

#include "glocal/rng.hpp"
#include "glocal/voxel_numbers.hpp"
#include "points.hpp"

namespace glocal::voxel_filter_test {
namespace {

using testing::ElementsAre;

TEST(VoxelFilter, TakesTheMeanOfEachVoxelInTheOrderOfFirstPoints) {
  Points points;
  for (const Point& p : {Point{1.1F, 0.0F, 0.0F}, Point{0.2F, 0.2F, 0.0F}, Point{1.5F, 0.5F, 0.25F},
                         Point{-0.1F, 0.2F, 0.0F}, Point{0.4F, 0.0F, 0.5F}})
    points.push_back(p);
  const VoxelGroups groups = voxel_groups(points, 1.0);
  EXPECT_THAT(groups.of_point, ElementsAre(0, 1, 0, 2, 1));
  EXPECT_EQ(groups.count, 3U);
  const Points means = voxel_downsampled(points, 1.0);
  ASSERT_EQ(means.size(), 3U);
  EXPECT_EQ(means[0], (Point{1.3F, 0.25F, 0.125F}));
  EXPECT_FLOAT_EQ(means[1].x, 0.3F);
  EXPECT_EQ(means[2], points[3]);
}

TEST(VoxelFilter, OfNothingIsNothing) {
  EXPECT_TRUE(voxel_downsampled({}, 0.1).empty());
}

TEST(VoxelFilter, KeepsPointsThatAreFarApart) {
  const Points points = test::points_of({{1e7F, -1e7F, 1e7F}, {-1e7F, 1e7F, -1e7F}});
  EXPECT_EQ(voxel_downsampled(points, 1e-3), points);
}

TEST(VoxelFilter, GroupsAsATreeOfVoxelsDoes) {
  Rng rng(5);
  Points points;
  for (int i = 0; i < 20'000; ++i) {
    const auto draw = [&] { return static_cast<float>(rng.uniform(-3.0, 3.0)); };
    const float x = draw(), y = draw();
    points.push_back({x, y, draw()});
  }
  constexpr double side = 0.25;
  std::map<std::array<double, 3>, std::uint32_t> numbers;
  const VoxelGroups groups = voxel_groups(points, side);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point p = points[i];
    const auto number = static_cast<std::uint32_t>(numbers.size());
    const auto at = numbers.emplace(
        std::array{std::floor(p.x / side), std::floor(p.y / side), std::floor(p.z / side)}, number);
    ASSERT_EQ(groups.of_point[i], at.first->second);
  }
  EXPECT_EQ(groups.count, numbers.size());
}

TEST(VoxelNumbers, CountInTheOrderInWhichVoxelsCome) {
  VoxelNumbers<int> numbers(1);  // Grows.
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(numbers.find_or_add({i % 500 - 250, 3, -i % 500}), i % 500);
  EXPECT_EQ(numbers.size(), 500U);
  EXPECT_EQ(numbers.find({-250, 3, 0}), 0U);
  EXPECT_EQ(numbers.find({-250, 3, 1}), VoxelNumbers<int>::none);
  numbers.clear();
  EXPECT_EQ(numbers.find({-250, 3, 0}), VoxelNumbers<int>::none);
}

}  // namespace
}  // namespace glocal::voxel_filter_test
