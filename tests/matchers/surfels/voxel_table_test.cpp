#include "matchers/surfels/voxel_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "files.hpp"

namespace glocal::surfels::voxel_table_test {
namespace {

/// A wall of 8 m, so far from the origin.
Points wall_at(float x) {
  Points points;
  for (int i = 0; i < 800; ++i) points.push_back({x + 0.01F * static_cast<float>(i), 3.0F, 1.0F});
  return points;
}

TEST(VoxelTable, FindsWhatWasSetAndNothingElse) {
  const Points points = wall_at(0.0F);
  VoxelTable table(VoxelRegion(points, 0.1F, 1));
  for (std::uint32_t i = 0; i < 800; ++i) table.slot(table.voxel_of(points[i])) = i / 100;
  for (std::uint32_t i = 0; i < 800; i += 50) EXPECT_EQ(table.slot(table.voxel_of(points[i])), i / 100);
  EXPECT_EQ(table.slot({0, 0, 0}), VoxelTable::none);
}

TEST(VoxelRegion, HoldsItsPointsHoweverFarAwayOrSaysThatItCannot) {
  for (const float x : {0.0F, 1e4F, -1e5F, 5e5F}) {
    const Points points = wall_at(x);
    const VoxelRegion region(points, 0.1F, 1);
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_TRUE(region.contains(points[i])) << x;
      EXPECT_TRUE(region.contains(region.voxel_of(points[i]))) << x;
    }
  }
  EXPECT_THAT(test::error_of([] { VoxelRegion(wall_at(5e6F), 0.1F, 1); }),
              testing::HasSubstr("m from the origin, where coordinates of 32 bits are 0.5 m apart"));
}

}  // namespace
}  // namespace glocal::surfels::voxel_table_test
