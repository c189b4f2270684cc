// A map of points made ready for a search in space.
#pragma once

#include <cstddef>
#include <memory>

#include "glocal/global_map.hpp"
#include "matchers/in_space/prepared_cloud.hpp"
#include "matchers/in_space/surfel_pairs.hpp"

namespace glocal {

/// What an index depends on, besides the map.
struct SpaceIndexRule {
  float voxel_size = 0.1F;     ///< m
  std::size_t pairs = 300000;  ///< At most.
};

/// Surfels of a map, what tells contact with them, and pairs of them by what a rigid motion leaves unchanged.
/// Built once for a map and read by all.
struct SpaceIndex {
  SpaceIndex(const Points& map_points, const SpaceIndexRule& rule);

  [[nodiscard]] std::size_t memory_bytes() const;

  PreparedCloud map;
  PairRule pair_rule;
  PairTable pairs;
  double build_ms = 0.0;  ///< To build it.
};

/// The index of a map, built for the first who asks for it and shared by all.
[[nodiscard]] std::shared_ptr<const SpaceIndex> space_index(const GlobalMap& map, const SpaceIndexRule& rule);

}  // namespace glocal
