// Saved indexes of maps. Size and checksum are repaired: otherwise nothing else would ever be read.
#include "matchers/indexed_ransam/saved_index.hpp"

#include "fuzz/harness.hpp"
#include "matchers/indexed_ransam/oriented_pair_index.hpp"
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

}  // namespace
}  // namespace glocal::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace glocal;
  const auto file = fuzz::write("map.index", with_checksum(fuzz::text_of(data, size)));
  return fuzz::answer([&] {
    const SavedIndex saved(file, fuzz::origin);
    saved.kind() == TriangleIndex::kind ? fuzz::read_triangles(saved) : fuzz::read_pairs(saved);
  });
}
