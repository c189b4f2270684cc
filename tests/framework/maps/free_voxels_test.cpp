#include "glocal/free_voxels.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <tuple>

#include "glocal/rng.hpp"

namespace glocal::test::free_voxels_test {
namespace {

TEST(FreeVoxels, KnowOfNothingAtFirst) {
  EXPECT_TRUE(FreeVoxels().empty());
  EXPECT_FALSE(FreeVoxels().contains({0.0F, 0.0F, 0.0F}));
  EXPECT_TRUE(FreeVoxels({}, 0.1).empty());
}

TEST(FreeVoxels, ReachFromOneSideToTheNext) {
  FreeVoxels voxels({}, 0.5);
  voxels.add(-1, 0, 8);  // x -0.5 to 0, y 0 to 0.5, z 4 to 4.5
  EXPECT_TRUE(voxels.contains({-0.5F, 0.0F, 4.0F}));
  EXPECT_TRUE(voxels.contains({-0.01F, 0.49F, 4.49F}));
  EXPECT_FALSE(voxels.contains({0.0F, 0.0F, 4.0F}));
  EXPECT_FALSE(voxels.contains({-0.51F, 0.0F, 4.0F}));
  EXPECT_FALSE(voxels.contains({-0.5F, 0.5F, 4.0F}));
  EXPECT_FALSE(voxels.contains({-0.5F, 0.0F, 3.99F}));
  EXPECT_FALSE(voxels.contains({-0.5F, 0.0F, 4.5F}));
}

TEST(FreeVoxels, AreNotWhereThereIsNoPlace) {
  FreeVoxels voxels({}, 0.5);
  voxels.add(0, 0, 0);
  for (const float nowhere : {std::nanf(""), std::numeric_limits<float>::infinity(), -1e30F, 1e9F}) {
    EXPECT_FALSE(voxels.contains({nowhere, 0.1F, 0.1F}));
    EXPECT_FALSE(voxels.contains({0.1F, nowhere, 0.1F}));
    EXPECT_FALSE(voxels.contains({0.1F, 0.1F, nowhere}));
  }
}

TEST(FreeVoxels, AnswerAsASetOfAllOfThem) {
  const Pose2 map_from_voxels{3.0, -2.0, 0.7};
  constexpr double side = 0.25;
  FreeVoxels voxels(map_from_voxels, side);
  std::set<std::tuple<int, int, int>> all;
  Rng rng(1);
  const auto coordinate = [&] { return static_cast<int>(rng.below(30)) - 15; };
  for (int i = 0; i < 9000; ++i) {
    const auto [column, row, layer] = *all.emplace(coordinate(), coordinate(), coordinate()).first;
    voxels.add(column, row, layer);
  }
  EXPECT_LE(voxels.bricks(), 64U);
  FreeVoxels shifted(map_from_voxels, side);
  shifted.add_shifted(voxels, 13);
  std::size_t free = 0;
  std::size_t asked = 0;
  for (int column = -18; column < 18; ++column) {
    for (int row = -18; row < 18; ++row) {
      for (int layer = -18; layer < 18; ++layer) {
        // The middle of the voxel, by hand.
        const double x = side * (column + 0.5);
        const double y = side * (row + 0.5);
        const Point middle{static_cast<float>(3.0 + std::cos(0.7) * x - std::sin(0.7) * y),
                           static_cast<float>(-2.0 + std::sin(0.7) * x + std::cos(0.7) * y),
                           static_cast<float>(side * (layer + 0.5))};
        const bool is_free = all.contains({column, row, layer});
        ASSERT_EQ(voxels.contains(middle), is_free) << column << " " << row << " " << layer;
        ASSERT_EQ(shifted.contains(middle), all.contains({column - 13, row, layer}));
        free += is_free ? 1 : 0;
        ++asked;
      }
    }
  }
  EXPECT_EQ(free, all.size());
  EXPECT_GT(asked, 2 * free);
}

}  // namespace
}  // namespace glocal::test::free_voxels_test
