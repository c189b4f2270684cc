#include "matchers/box_search/map_area.hpp"

#include <gtest/gtest.h>

namespace glocal::map_area_test {
namespace {

/// Two points at opposite corners of a square.
GlobalMap square(float side) {
  MapData data;
  data.points.push_back({-1.0F, 5.0F, 0.0F});
  data.points.push_back({side - 1.0F, side + 5.0F, 0.0F});
  return GlobalMap(std::move(data));
}

TEST(MapArea, IsThatOfTheRectangleAboutThePoints) {
  EXPECT_NEAR(area_of(square(100.0F).points()), 1e4, 1e-6);
}

TEST(MapArea, BoxesGrowWithTheMapUpToTheContact) {
  EXPECT_EQ(automatic_box_cell(square(100.0F), 0.1), 0.025);
  EXPECT_EQ(automatic_box_cell(square(200.0F), 0.1), 0.05);
  EXPECT_EQ(automatic_box_cell(square(600.0F), 0.1), 0.1);
  EXPECT_EQ(automatic_box_cell(square(600.0F), 0.06), 0.06);
}

TEST(MapArea, LooksGrowInProportion) {
  EXPECT_EQ(looks_on(square(100.0F), 1000), 1000U);
  EXPECT_EQ(looks_on(square(400.0F), 1000), 8000U);
}

}  // namespace
}  // namespace glocal::map_area_test
