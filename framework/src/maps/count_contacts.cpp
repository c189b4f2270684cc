#include "maps/count_contacts.hpp"

#include <algorithm>
#include <array>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "maps/count_contacts.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace glocal::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
// Eight lanes at most: a batch of eq. 5 is eight points.
using Floats = hn::CappedTag<float, 8>;
using Words = hn::Rebind<std::uint32_t, Floats>;
using Ints = hn::Rebind<std::int32_t, Floats>;

/// Where points fall in the grid.
struct Voxels {
  hn::Mask<Floats> inside;
  hn::Vec<Words> column, row, layer;  ///< 0 where not inside.
};

// Products are added without fusing them, so that all instruction sets round alike.
HWY_INLINE Voxels voxels_of(const VoxelLookup& grid, const PointRun& points, std::size_t i) {
  const Floats d;
  const auto x = hn::LoadU(d, points.x + i);
  const auto y = hn::LoadU(d, points.y + i);
  const auto z = hn::LoadU(d, points.z + i);
  const auto at = [&](float a, float b, float c) {
    return hn::Add(hn::Add(hn::Mul(hn::Set(d, a), x), hn::Mul(hn::Set(d, b), y)), hn::Set(d, c));
  };
  const auto within = [&](hn::Vec<Floats> value, float end) {
    return hn::And(hn::Ge(value, hn::Zero(d)), hn::Lt(value, hn::Set(d, end)));
  };
  const auto column = at(grid.xx, grid.xy, grid.x0);
  const auto row = at(grid.yx, grid.yy, grid.y0);
  const auto layer = hn::Add(hn::Mul(hn::Set(d, grid.zz), z), hn::Set(d, grid.z0));
  const auto inside =
      hn::And(hn::And(within(column, grid.columns), within(row, grid.rows)), within(layer, grid.layers));
  // Compared as floats, so that points far away and NaN never reach the conversion to integers.
  const auto whole = [&](hn::Vec<Floats> value) {
    return hn::BitCast(Words(), hn::ConvertTo(Ints(), hn::IfThenElseZero(inside, value)));
  };
  return {inside, whole(column), whole(row), whole(layer)};
}

/// How many of them have their bit set, in voxels joined by 2^shift along each axis.
template <int shift>
HWY_INLINE std::size_t count_set(const VoxelBits& bits, const Voxels& voxels) {
  const Floats d;
  const Words words;
  const auto column = hn::ShiftRight<shift>(voxels.column);
  const auto row = hn::Mul(hn::ShiftRight<shift>(voxels.row), hn::Set(words, bits.row_words));
  const auto layer = hn::Mul(hn::ShiftRight<shift>(voxels.layer), hn::Set(words, bits.layer_words));
  const auto word = hn::Add(hn::Add(hn::ShiftRight<5>(column), row), layer);
  const auto found = hn::GatherIndex(words, bits.words, hn::BitCast(Ints(), word));
  const auto bit = hn::Shl(hn::Set(words, 1U), hn::And(column, hn::Set(words, 31U)));
  return hn::CountTrue(d, hn::And(voxels.inside, hn::RebindMask(d, hn::TestBit(found, bit))));
}

/// The last points of a run, fewer than a vector has lanes; what is not a number is in contact with nothing.
struct Rest {
  Rest(const PointRun& points, std::size_t begin, std::size_t end) {
    for (auto& axis : xyz) axis.fill(std::numeric_limits<float>::quiet_NaN());
    std::copy(points.x + begin, points.x + end, xyz[0].begin());
    std::copy(points.y + begin, points.y + end, xyz[1].begin());
    std::copy(points.z + begin, points.z + end, xyz[2].begin());
  }
  [[nodiscard]] PointRun run() const { return {xyz[0].data(), xyz[1].data(), xyz[2].data(), xyz[0].size()}; }

  std::array<std::array<float, 8>, 3> xyz;
};

template <int shift>
HWY_INLINE std::size_t count_batch(const VoxelLookup& grid, const VoxelBits& bits, const PointRun& points,
                                   std::size_t i, std::size_t end) {
  const std::size_t lanes = hn::Lanes(Floats());
  std::size_t in_contact = 0;
  for (; i + lanes <= end; i += lanes) in_contact += count_set<shift>(bits, voxels_of(grid, points, i));
  if (i == end) return in_contact;
  const Rest rest(points, i, end);
  return in_contact + count_set<shift>(bits, voxels_of(grid, rest.run(), 0));
}

ContactIndex::Count count_contacts_in_vectors(const VoxelLookup& grid, const PointRun& points,
                                              std::size_t batch, std::span<const std::uint32_t> least) {
  // Most poses miss most points of the first batch by far. The coarse bits, which stay in the fastest memory,
  // tell: who has too few there has too few.
  const std::size_t first = std::min(batch, points.size);
  if (least.front() > 0) {
    const std::size_t most = count_batch<VoxelLookup::coarse_shift>(grid, grid.coarse, points, 0, first);
    if (most < least.front()) return {most, first};
  }
  std::size_t in_contact = 0;
  std::size_t i = 0;
  for (const std::uint32_t enough : least) {
    const std::size_t end = std::min(i + batch, points.size);
    in_contact += count_batch<0>(grid, grid.fine, points, i, end);
    i = end;
    if (in_contact < enough) break;
  }
  return {in_contact, i};
}

}  // namespace
}  // namespace glocal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace glocal {

HWY_EXPORT(count_contacts_in_vectors);

ContactIndex::Count count_contacts(const VoxelLookup& grid, const PointRun& points, std::size_t batch,
                                   std::span<const std::uint32_t> least) {
  return HWY_DYNAMIC_DISPATCH(count_contacts_in_vectors)(grid, points, batch, least);
}

}  // namespace glocal
#endif
