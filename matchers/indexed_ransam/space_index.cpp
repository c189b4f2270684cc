#include "matchers/indexed_ransam/space_index.hpp"

#include <fmt/format.h>

#include <chrono>

#include "matchers/in_space/pose_search.hpp"

namespace glocal {

SpaceIndex::SpaceIndex(const Points& map_points, const SpaceIndexRule& rule)
    : map(map_points, rule.voxel_size, std::nullopt, false),
      pair_rule(glocal::pair_rule(rule.voxel_size, true)),
      pairs(map.surfels, pair_rule, rule.pairs, Rng(1)) {}

std::size_t SpaceIndex::memory_bytes() const {
  constexpr std::size_t surfel = 7 * sizeof(float);
  return map.surfels.size() * surfel + map.contact.memory_bytes() + pairs.memory_bytes();
}

std::shared_ptr<const SpaceIndex> space_index(const GlobalMap& map, const SpaceIndexRule& rule) {
  return map.index<SpaceIndex>(fmt::format("voxel_size {}, pairs {}", rule.voxel_size, rule.pairs), [&] {
    const auto start = std::chrono::steady_clock::now();
    SpaceIndex index(map.points(), rule);
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
    index.build_ms = time.count();
    return index;
  });
}

}  // namespace glocal
