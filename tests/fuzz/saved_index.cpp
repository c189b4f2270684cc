// Saved indexes of maps. Size and checksum are repaired: otherwise nothing else would ever be read.
#include "matchers/indexed_ransam/saved_index.hpp"

#include "fuzz/harness.hpp"
#include "matchers/in_space/pose_search.hpp"
#include "matchers/indexed_ransam/oriented_pair_index.hpp"
#include "matchers/indexed_ransam/space_index.hpp"
#include "matchers/indexed_ransam/triangle_index.hpp"

namespace glocal::fuzz {
namespace {

const IndexOrigin origin{77, "rule"};
/// So coarse that there are few bins, and files stay small.
const OrientedPairRule rule{.min_length = 0.5, .max_length = 1.0, .length_cell = 0.25, .angle_cells = 2};

void read_pairs(const SavedIndex& saved) {
  const OrientedPairIndex index(saved, rule);
  const auto points = static_cast<std::uint32_t>(index.oriented_points().size());
  for (std::uint32_t i = 0; i + 1 < points; ++i) {
    for (const auto& pair : index.find(index.oriented_points(), {i, i + 1}))
      must_hold(pair.first < points && pair.second < points, "a pair has a point that is not there");
  }
}

void read_triangles(const SavedIndex& saved) {
  const TriangleIndex index(saved);
  for (Relation relation = 0; relation < 100; ++relation) {
    for (const Triple& triple : index.find(relation)) {
      for (const auto corner : triple) must_hold(corner < index.points().size(), "a corner is not there");
    }
  }
}

/// A floor and a wall, 2 m x 1 m each.
Points corner() {
  Points points;
  for (int i = 0; i < 20; ++i) {
    for (int k = 0; k < 10; ++k) {
      const float along = 0.1F * static_cast<float>(i);
      const float across = 0.1F * static_cast<float>(k);
      points.push_back({along, across, 0.0F});
      points.push_back({along, 0.0F, across});
    }
  }
  return points;
}

void read_surfel_pairs(const SavedIndex& saved) {
  // A single pair, and few buckets.
  const SpaceIndexRule space{.voxel_size = 0.25F, .pairs = 1};
  const SpaceIndex index(saved, space);
  must_hold(index.map.surfels.weights.size() == index.map.surfels.size(), "a surfel has no weight");
  const PreparedCloud source(corner(), space.voxel_size, Point{1.0F, 0.5F, 0.5F}, false);
  const PoseSearch search(index.map, index.pairs, index.pair_rule, {.rounds = 2, .draws = 20, .refined = 2});
  for (const FoundPose& found : search.find(source, Rng(1)))
    must_hold(found.score <= 1.0, "a pose has more contact than there is");
}

}  // namespace
}  // namespace glocal::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace glocal;
  const auto file = fuzz::write("map.index", with_checksum(fuzz::text_of(data, size)));
  return fuzz::answer([&] {
    const SavedIndex saved(file, fuzz::origin);
    if (saved.kind() == TriangleIndex::kind) return fuzz::read_triangles(saved);
    if (saved.kind() == SpaceIndex::kind) return fuzz::read_surfel_pairs(saved);
    fuzz::read_pairs(saved);
  });
}
