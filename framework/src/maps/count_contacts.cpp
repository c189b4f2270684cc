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

/// Where points fall in the grid.
template <class D>
struct Voxels {
  using Words = hn::Vec<hn::Rebind<std::uint32_t, D>>;
  hn::Mask<D> inside;
  Words column, row, layer;  ///< 0 where not inside.
};

/// The way from a point to its voxel: column = xx * x + xy * y + x0, row likewise, layer = zz * z + z0.
template <class D>
struct Lookup {
  using V = hn::Vec<D>;
  V xx, xy, x0, yx, yy, y0, zz, z0;

  HWY_INLINE Lookup(D d, const VoxelGrid& grid, V cosine, V sine, V x, V y) {
    const V scale = hn::Set(d, grid.scale);
    xx = hn::Mul(cosine, scale);
    yx = hn::Mul(sine, scale);
    xy = hn::Neg(yx);
    yy = xx;
    x0 = hn::Mul(hn::Sub(x, hn::Set(d, grid.min.x)), scale);
    y0 = hn::Mul(hn::Sub(y, hn::Set(d, grid.min.y)), scale);
    zz = hn::Set(d, grid.scale_z);
    z0 = hn::Set(d, -grid.min.z * grid.scale_z);
  }
};

// Products are added without fusing them, so that all instruction sets round alike.
template <class D>
HWY_INLINE Voxels<D> voxels_of(D d, const VoxelGrid& grid, const Lookup<D>& lookup, hn::Vec<D> x,
                               hn::Vec<D> y, hn::Vec<D> z) {
  using V = hn::Vec<D>;
  const hn::Rebind<std::int32_t, D> ints;
  const hn::Rebind<std::uint32_t, D> words;
  const auto at = [&](V a, V b, V c) { return hn::Add(hn::Add(hn::Mul(a, x), hn::Mul(b, y)), c); };
  const auto within = [&](V value, float end) {
    return hn::And(hn::Ge(value, hn::Zero(d)), hn::Lt(value, hn::Set(d, end)));
  };
  const V column = at(lookup.xx, lookup.xy, lookup.x0);
  const V row = at(lookup.yx, lookup.yy, lookup.y0);
  const V layer = hn::Add(hn::Mul(lookup.zz, z), lookup.z0);
  const auto inside =
      hn::And(hn::And(within(column, grid.columns), within(row, grid.rows)), within(layer, grid.layers));
  // Compared as floats, so that points far away and NaN never reach the conversion to integers.
  const auto whole = [&](V value) {
    return hn::BitCast(words, hn::ConvertTo(ints, hn::IfThenElseZero(inside, value)));
  };
  return {inside, whole(column), whole(row), whole(layer)};
}

/// Where bits are and how they lie.
enum class Bits { coarse, fine, in_bricks };

/// Which of them have their bit set.
template <Bits kind, class D>
HWY_INLINE hn::Mask<D> are_set(D d, const VoxelBits& bits, const Voxels<D>& voxels) {
  constexpr int joined = kind == Bits::coarse ? VoxelGrid::coarse_shift : 0;
  constexpr int apart = kind == Bits::in_bricks ? brick_shift : joined;
  const hn::Rebind<std::int32_t, D> ints;
  const hn::Rebind<std::uint32_t, D> words;
  const auto column = hn::ShiftRight<joined>(voxels.column);
  const auto row = hn::Mul(hn::ShiftRight<apart>(voxels.row), hn::Set(words, bits.row_words));
  const auto layer = hn::Mul(hn::ShiftRight<apart>(voxels.layer), hn::Set(words, bits.layer_words));
  auto word = hn::Add(hn::Add(hn::ShiftRight<5>(column), row), layer);
  if constexpr (kind == Bits::in_bricks) {
    const auto within = hn::Set(words, (1U << brick_shift) - 1);
    word = hn::GatherIndex(words, bits.bricks, hn::BitCast(ints, word));
    word = hn::Add(word, hn::And(voxels.row, within));
    word = hn::Add(word, hn::ShiftLeft<apart>(hn::And(voxels.layer, within)));
  }
  const auto found = hn::GatherIndex(words, bits.words, hn::BitCast(ints, word));
  const auto bit = hn::Shl(hn::Set(words, 1U), hn::And(column, hn::Set(words, 31U)));
  return hn::And(voxels.inside, hn::RebindMask(d, hn::TestBit(found, bit)));
}

// --- One pose, many points -----------------------------------------------------------------------------

// Eight lanes at most: a batch of eq. 5 is eight points.
using Batch = hn::CappedTag<float, 8>;

template <Bits kind>
HWY_INLINE std::size_t count_set(const VoxelGrid& grid, const Lookup<Batch>& lookup, const PointRun& points,
                                 std::size_t i) {
  const Batch d;
  const auto voxels = voxels_of(d, grid, lookup, hn::LoadU(d, points.x + i), hn::LoadU(d, points.y + i),
                                hn::LoadU(d, points.z + i));
  return hn::CountTrue(d, are_set<kind>(d, grid.fine, voxels));
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

template <Bits kind>
HWY_INLINE std::size_t count_batch(const VoxelGrid& grid, const Lookup<Batch>& lookup, const PointRun& points,
                                   std::size_t i, std::size_t end) {
  const std::size_t lanes = hn::Lanes(Batch());
  std::size_t in_contact = 0;
  for (; i + lanes <= end; i += lanes) in_contact += count_set<kind>(grid, lookup, points, i);
  if (i == end) return in_contact;
  const Rest rest(points, i, end);
  return in_contact + count_set<kind>(grid, lookup, rest.run(), 0);
}

template <Bits kind>
HWY_INLINE ContactIndex::Count count_while(const VoxelGrid& grid, const Transform& map_from_points,
                                           const PointRun& points, std::size_t batch,
                                           std::span<const std::uint32_t> least) {
  const Batch d;
  const Transform& t = map_from_points;
  const Lookup<Batch> lookup(d, grid, hn::Set(d, t.cosine()), hn::Set(d, t.sine()), hn::Set(d, t.x()),
                             hn::Set(d, t.y()));
  std::size_t in_contact = 0;
  std::size_t i = 0;
  for (const std::uint32_t enough : least) {
    const std::size_t end = std::min(i + batch, points.size);
    in_contact += count_batch<kind>(grid, lookup, points, i, end);
    i = end;
    if (in_contact < enough) break;
  }
  return {in_contact, i};
}

ContactIndex::Count count_contacts_in_vectors(const VoxelGrid& grid, const Transform& map_from_points,
                                              const PointRun& points, std::size_t batch,
                                              std::span<const std::uint32_t> least) {
  return grid.fine.bricks == nullptr
             ? count_while<Bits::fine>(grid, map_from_points, points, batch, least)
             : count_while<Bits::in_bricks>(grid, map_from_points, points, batch, least);
}

// --- Many poses, a few points each ---------------------------------------------------------------------

void count_coarse_in_vectors(const VoxelGrid& grid, const Points& points, std::size_t n,
                             const MotionBatch& motions, std::size_t size,
                             const ContactIndex::BatchColumn& begins, ContactIndex::BatchColumn& at_most) {
  using Poses = hn::CappedTag<float, 16>;
  const Poses d;
  const hn::Rebind<std::int32_t, Poses> ints;
  const hn::Rebind<std::uint32_t, Poses> words;
  for (std::size_t i = 0; i < size; i += hn::Lanes(d)) {
    const Lookup<Poses> lookup(d, grid, hn::Load(d, &motions.cosine[i]), hn::Load(d, &motions.sine[i]),
                               hn::Load(d, &motions.x[i]), hn::Load(d, &motions.y[i]));
    auto point = hn::BitCast(ints, hn::LoadU(words, &begins[i]));
    auto count = hn::Zero(ints);
    for (std::size_t k = 0; k < n; ++k, point = hn::Add(point, hn::Set(ints, 1))) {
      const auto voxels =
          voxels_of(d, grid, lookup, hn::GatherIndex(d, points.x.data(), point),
                    hn::GatherIndex(d, points.y.data(), point), hn::GatherIndex(d, points.z.data(), point));
      const auto set = are_set<Bits::coarse>(d, grid.coarse, voxels);
      // A mask is -1 in each lane that is set.
      count = hn::Sub(count, hn::VecFromMask(ints, hn::RebindMask(ints, set)));
    }
    hn::StoreU(hn::BitCast(words, count), words, &at_most[i]);
  }
}

}  // namespace
}  // namespace glocal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace glocal {

HWY_EXPORT(count_contacts_in_vectors);
HWY_EXPORT(count_coarse_in_vectors);

ContactIndex::Count count_contacts(const VoxelGrid& grid, const Transform& map_from_points,
                                   const PointRun& points, std::size_t batch,
                                   std::span<const std::uint32_t> least) {
  return HWY_DYNAMIC_DISPATCH(count_contacts_in_vectors)(grid, map_from_points, points, batch, least);
}

void count_coarse(const VoxelGrid& grid, const Points& points, std::size_t n, const MotionBatch& motions,
                  std::size_t size, const ContactIndex::BatchColumn& begins,
                  ContactIndex::BatchColumn& at_most) {
  HWY_DYNAMIC_DISPATCH(count_coarse_in_vectors)(grid, points, n, motions, size, begins, at_most);
}

}  // namespace glocal
#endif
