// What is the same in a local map and in the known one however they lie, sorted once for the known one:
// oriented point pairs, or triangles.
#pragma once

#include <memory>
#include <string>
#include <variant>

#include "glocal/global_map.hpp"
#include "matchers/common/oriented_points.hpp"
#include "matchers/common/triangle.hpp"
#include "matchers/indexed_ransam/oriented_pair_index.hpp"
#include "matchers/indexed_ransam/triangle_index.hpp"

namespace glocal::indexed_ransam {

using RelationIndex = std::variant<OrientedPairIndex, TriangleIndex>;

/// What an index depends on, besides the map.
struct RelationRule {
  std::string relation = "auto";    ///< Or "oriented_pair", or "triangle".
  double min_oriented_share = 0.3;  ///< auto: triangles where fewer of the map's places have a normal.
  OrientedPointRule points = {};
  OrientedPairRule pairs = {};
  double min_height = 0.3;  ///< m; of triangles, which have the lengths of pairs.

  [[nodiscard]] TriangleRule triangles() const;
};

/// The index of a map, built for the first who asks for it and shared by all.
[[nodiscard]] std::shared_ptr<const RelationIndex> relation_index(const GlobalMap& map,
                                                                  const RelationRule& rule, int threads);

/// The points that its pairs or triangles are made of.
[[nodiscard]] std::size_t points_of(const RelationIndex& index);

}  // namespace glocal::indexed_ransam
