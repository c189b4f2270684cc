// A map of points made ready for a search in space.
#pragma once

#include <cstddef>
#include <memory>

#include "glocal/global_map.hpp"
#include "matchers/surfels/prepared_cloud.hpp"
#include "matchers/surfels/surfel_pairs.hpp"

namespace glocal::surfel_ransam {

/// What an index depends on, besides the map.
struct SurfelIndexRule {
  float voxel_size = 0.1F;     ///< m
  std::size_t pairs = 300000;  ///< At most.
};

/// Surfels of a map, what tells contact with them, and pairs of them by what a rigid motion leaves unchanged.
/// Built once for a map and read by all.
struct SurfelIndex {
  SurfelIndex(const Points& map_points, const SurfelIndexRule& rule);

  [[nodiscard]] std::size_t memory_bytes() const;

  surfels::PreparedCloud map;
  surfels::PairRule pair_rule;
  surfels::PairTable pairs;
  double build_ms = 0.0;  ///< To build it.
};

/// The index of a map, built for the first who asks for it and shared by all.
[[nodiscard]] std::shared_ptr<const SurfelIndex> surfel_index(const GlobalMap& map,
                                                              const SurfelIndexRule& rule);

}  // namespace glocal::surfel_ransam
