#include "matchers/indexed_ransam/space_index.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <span>

#include "matchers/in_space/pose_search.hpp"

namespace glocal {
namespace {

/// Which section of a saved index has what.
enum Section : std::size_t { points = 0, normals = 3, brick_numbers = 6, nearest, starts, pairs };

/// The rule as a saved index keeps it.
std::string text_of(const SpaceIndexRule& rule) {
  return fmt::format("relation surfel_pair, voxel_size {}, pairs {}", rule.voxel_size, rule.pairs);
}

IndexOrigin origin_of(const GlobalMap& map, const SpaceIndexRule& rule) {
  return {digest_of(map), text_of(rule)};
}

/// Three coordinates, in a section each.
Points coordinates(const SavedIndex& saved, std::size_t first) {
  Points read{saved.section<float>(first).copy(), saved.section<float>(first + 1).copy(),
              saved.section<float>(first + 2).copy()};
  saved.expect_fit(read.y.size() == read.size() && read.z.size() == read.size());
  for (const auto* values : {&read.x, &read.y, &read.z}) saved.expect_finite(*values);
  return read;
}

bool has_unit_length(const Point& normal) {
  constexpr float rounding = 1e-3F;
  return std::abs(dot(normal, normal) - 1.0F) < rounding;
}

Surfels surfels_from(const SavedIndex& saved) {
  saved.expect(SpaceIndex::kind);
  Surfels surfels{coordinates(saved, Section::points), coordinates(saved, Section::normals), {}};
  saved.expect_fit(surfels.normals.size() == surfels.points.size());
  for (std::size_t i = 0; i < surfels.size(); ++i) {
    if (!has_unit_length(surfels.normals[i]))
      saved.fail("the index is damaged: it has normals that are not of unit length");
  }
  surfels.weights = balanced_weights(surfels.normals);
  return surfels;
}

SurfelContact contact_from(const SavedIndex& saved, const Surfels& surfels, float voxel_size) {
  const VoxelRegion region = SurfelContact::region_of(surfels, voxel_size);
  const auto bricks = saved.section<std::uint32_t>(Section::brick_numbers);
  const auto numbers = saved.section<std::uint32_t>(Section::nearest);
  saved.expect_fit(bricks.size() == region.bricks() && numbers.size() % VoxelRegion::voxels_per_brick == 0);
  saved.expect_below_or(FixedVoxelTable::none, numbers.size() / VoxelRegion::voxels_per_brick, bricks.span());
  saved.expect_below_or(FixedVoxelTable::none, surfels.size(), numbers.span());
  return {surfels, FixedVoxelTable(region, bricks, numbers), false};
}

PreparedCloud map_from(const SavedIndex& saved, float voxel_size) {
  Surfels surfels = surfels_from(saved);
  SurfelContact contact = contact_from(saved, surfels, voxel_size);
  return {std::move(surfels), std::move(contact)};
}

PairTable pairs_from(const SavedIndex& saved, std::size_t surfels, std::size_t asked) {
  const auto begins = saved.section<std::uint32_t>(Section::starts);
  const auto entries = saved.section<SurfelPair>(Section::pairs);
  saved.expect_fit(begins.size() == PairTable::starts_for(asked));
  saved.expect_bins(begins.span(), entries.size());
  saved.expect_below(surfels, entries.span());
  return {asked, begins, entries};
}

SpaceIndex index_of(const GlobalMap& map, const SpaceIndexRule& rule, const std::filesystem::path& file) {
  if (file.empty()) return {map.points(), rule};
  return {SavedIndex(file, origin_of(map, rule)), rule};
}

}  // namespace

SpaceIndex::SpaceIndex(const Points& map_points, const SpaceIndexRule& rule)
    : map(map_points, rule.voxel_size, std::nullopt, false),
      pair_rule(glocal::pair_rule(rule.voxel_size, true)),
      pairs(map.surfels, pair_rule, rule.pairs, Rng(1)) {}

SpaceIndex::SpaceIndex(const SavedIndex& saved, const SpaceIndexRule& rule)
    : map(map_from(saved, rule.voxel_size)),
      pair_rule(glocal::pair_rule(rule.voxel_size, true)),
      pairs(pairs_from(saved, map.surfels.size(), rule.pairs)) {}

std::string SpaceIndex::saved(const IndexOrigin& origin) const {
  const Points& p = map.surfels.points;
  const Points& n = map.surfels.normals;
  const FixedVoxelTable& table = map.contact.nearest_numbers();
  const auto bytes = [](const auto& values) { return std::as_bytes(std::span(values)); };
  return saved_index(kind, origin,
                     {bytes(p.x), bytes(p.y), bytes(p.z), bytes(n.x), bytes(n.y), bytes(n.z),
                      bytes(table.brick_numbers().span()), bytes(table.voxel_numbers().span()),
                      bytes(pairs.starts()), bytes(pairs.pairs())});
}

std::size_t SpaceIndex::memory_bytes() const {
  constexpr std::size_t surfel = 7 * sizeof(float);
  return map.surfels.size() * surfel + map.contact.memory_bytes() + pairs.memory_bytes();
}

std::shared_ptr<const SpaceIndex> space_index(const GlobalMap& map, const SpaceIndexRule& rule,
                                              const std::filesystem::path& file) {
  return map.index<SpaceIndex>(file.string() + ": " + text_of(rule), [&] {
    const auto start = std::chrono::steady_clock::now();
    SpaceIndex index = index_of(map, rule, file);
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
    index.build_ms = time.count();
    return index;
  });
}

std::string saved_index(const SpaceIndex& index, const GlobalMap& map, const SpaceIndexRule& rule) {
  return index.saved(origin_of(map, rule));
}

}  // namespace glocal
