#include "matchers/indexed_ransam/relation_index.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "test_world.hpp"

namespace glocal::indexed_ransam::relation_index_test {
namespace {

/// A wall, and single points that have no direction.
std::shared_ptr<const GlobalMap> wall_and_poles() {
  MapData data;
  test::add_wall(data.points, {{0, 0}, {4, 0}});
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 5; ++column)
      data.points.push_back({static_cast<float>(column), 2.0F + static_cast<float>(row), 0.0F});
  }
  data.grid = {{-1.0, -1.0, 0.0}, 0.1, 80, 80, PackedCells(std::size_t{80} * 80, Cell::free)};
  return std::make_shared<const GlobalMap>(std::move(data));
}

bool has_triangles(const RelationIndex& index) {
  return std::holds_alternative<TriangleIndex>(index);
}

TEST(RelationIndex, TakesTrianglesWhereTooFewPlacesHaveANormal) {
  const auto map = wall_and_poles();
  const double share = oriented_points_of(*map, {}).share;
  ASSERT_GT(share, 0.5);
  ASSERT_LT(share, 0.9);
  EXPECT_FALSE(has_triangles(*relation_index(*map, {.min_oriented_share = share}, 1)));
  EXPECT_TRUE(has_triangles(*relation_index(*map, {.min_oriented_share = share + 1e-6}, 1)));
  EXPECT_FALSE(
      has_triangles(*relation_index(*map, {.relation = "oriented_pair", .min_oriented_share = 1.0}, 1)));
  EXPECT_TRUE(has_triangles(*relation_index(*map, {.relation = "triangle", .min_oriented_share = 0.0}, 1)));
}

TEST(RelationIndex, IsSharedByAllWhoAskForTheSame) {
  const auto map = test::small_world();
  const auto one = relation_index(*map, {}, 1);
  EXPECT_EQ(relation_index(*map, {}, 2), one);
  EXPECT_NE(relation_index(*map, {.pairs = {.max_length = 5.0}}, 1), one);
}

}  // namespace
}  // namespace glocal::indexed_ransam::relation_index_test
