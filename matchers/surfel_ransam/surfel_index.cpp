#include "matchers/surfel_ransam/surfel_index.hpp"

#include <fmt/format.h>

#include <chrono>

#include "matchers/surfels/pose_search.hpp"

namespace glocal::surfel_ransam {

SurfelIndex::SurfelIndex(const Points& map_points, const SurfelIndexRule& rule)
    : map(map_points, rule.voxel_size, std::nullopt),
      pair_rule(surfels::pair_rule(rule.voxel_size, true)),
      pairs(map.surfels, pair_rule, rule.pairs, Rng(1)) {}

std::size_t SurfelIndex::memory_bytes() const {
  constexpr std::size_t surfel = 7 * sizeof(float);
  return map.surfels.size() * surfel + map.contact.memory_bytes() + pairs.memory_bytes();
}

std::shared_ptr<const SurfelIndex> surfel_index(const GlobalMap& map, const SurfelIndexRule& rule) {
  return map.index<SurfelIndex>(fmt::format("voxel_size {}, pairs {}", rule.voxel_size, rule.pairs), [&] {
    const auto start = std::chrono::steady_clock::now();
    SurfelIndex index(map.points(), rule);
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
    index.build_ms = time.count();
    return index;
  });
}

}  // namespace glocal::surfel_ransam
