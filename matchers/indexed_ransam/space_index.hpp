// A map of points made ready for a search in space.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

#include "glocal/global_map.hpp"
#include "matchers/in_space/prepared_cloud.hpp"
#include "matchers/in_space/surfel_pairs.hpp"
#include "matchers/indexed_ransam/saved_index.hpp"

namespace glocal {

/// What an index depends on, besides the map.
struct SpaceIndexRule {
  float voxel_size = 0.1F;     ///< m
  std::size_t pairs = 300000;  ///< At most.
};

/// Surfels of a map, what tells contact with them, and pairs of them by what a rigid motion leaves unchanged.
/// Built once for a map and read by all.
struct SpaceIndex {
  static constexpr const char* kind = "surfel pairs";

  SpaceIndex(const Points& map_points, const SpaceIndexRule& rule);
  /// Reads what saved() left. Throws ConfigError where it is no index for this rule.
  SpaceIndex(const SavedIndex& saved, const SpaceIndexRule& rule);

  /// The content of a file that holds the index.
  [[nodiscard]] std::string saved(const IndexOrigin& origin) const;
  [[nodiscard]] std::size_t memory_bytes() const;

  PreparedCloud map;
  PairRule pair_rule;
  PairTable pairs;
  double build_ms = 0.0;  ///< To build it, or to load it.
};

/// The index of a map, shared by all who ask for it: read from a file, or built where the path is empty.
/// Throws ConfigError where the file is not the index of this map and this rule.
[[nodiscard]] std::shared_ptr<const SpaceIndex> space_index(const GlobalMap& map, const SpaceIndexRule& rule,
                                                            const std::filesystem::path& file);

/// The content of a file with the index of this map and this rule.
[[nodiscard]] std::string saved_index(const SpaceIndex& index, const GlobalMap& map,
                                      const SpaceIndexRule& rule);

}  // namespace glocal
