#include "matchers/indexed_ransam/relation_index.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace glocal::indexed_ransam {
namespace {

/// Equal for equal rules.
std::string text_of(const RelationRule& r) {
  return fmt::format(
      "relation {}, min_oriented_share {}, min_length {}, max_length {}, length_cell {}, angle_cells {}, "
      "min_height {}, max_entries {}, voxel_size {}, normal_radius {}",
      r.relation, r.min_oriented_share, r.pairs.min_length, r.pairs.max_length, r.pairs.length_cell,
      r.pairs.angle_cells, r.min_height, r.pairs.max_entries, r.points.voxel_size, r.points.radius);
}

RelationIndex index_of(const GlobalMap& map, const RelationRule& rule, int threads) {
  if (rule.relation != "triangle") {
    OrientedPoints points = oriented_points_of(map, rule.points, threads);
    if (rule.relation == "oriented_pair" || points.share >= rule.min_oriented_share)
      return OrientedPairIndex(std::move(points), rule.pairs, threads);
  }
  return TriangleIndex(downsampled_in_plane(map.points(), rule.points.voxel_size), rule.triangles(),
                       rule.pairs.max_entries, threads);
}

}  // namespace

TriangleRule RelationRule::triangles() const {
  return {.cell = pairs.length_cell,
          .min_side = pairs.min_length,
          .min_height = min_height,
          .max_side = std::min(pairs.max_length, largest_side(pairs.length_cell))};
}

std::shared_ptr<const RelationIndex> relation_index(const GlobalMap& map, const RelationRule& rule,
                                                    int threads) {
  return map.index<RelationIndex>(text_of(rule), [&] { return index_of(map, rule, threads); });
}

std::size_t points_of(const RelationIndex& index) {
  struct Size {
    std::size_t operator()(const OrientedPairIndex& pairs) const { return pairs.oriented_points().size(); }
    std::size_t operator()(const TriangleIndex& triangles) const { return triangles.points().size(); }
  };
  return std::visit(Size{}, index);
}

}  // namespace glocal::indexed_ransam
