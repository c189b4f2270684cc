#include "maps/look_up.hpp"

#include <algorithm>
#include <array>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "maps/look_up.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace glocal::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, 16>;
using Ints = hn::Rebind<std::int32_t, Floats>;
using Words = hn::Rebind<std::uint32_t, Floats>;
using V = hn::Vec<Floats>;
using I = hn::Vec<Ints>;
using M = hn::Mask<Floats>;

struct Place {
  V x, y;
};

// Products are added without fusing them, so that all instruction sets round as plain code does.
HWY_INLINE Place moved(const Transform& t, const Place& p) {
  const Floats d;
  const V c = hn::Set(d, t.cosine());
  const V s = hn::Set(d, t.sine());
  return {hn::Add(hn::Sub(hn::Mul(c, p.x), hn::Mul(s, p.y)), hn::Set(d, t.x())),
          hn::Add(hn::Add(hn::Mul(s, p.x), hn::Mul(c, p.y)), hn::Set(d, t.y()))};
}

/// Calls visit(first, lanes, points) for as many points at a time as there are lanes; the last of them are
/// repeated.
template <class Visit>
HWY_INLINE void for_all(const Points& points, Visit visit) {
  const Floats d;
  const std::size_t lanes = hn::Lanes(d);
  const std::size_t n = points.size();
  std::size_t i = 0;
  for (; i + lanes <= n; i += lanes)
    visit(i, lanes, Place{hn::LoadU(d, &points.x[i]), hn::LoadU(d, &points.y[i])});
  if (i == n) return;
  std::array<float, 16> x{};
  std::array<float, 16> y{};
  for (std::size_t k = 0; k < lanes; ++k) {
    x[k] = points.x[std::min(i + k, n - 1)];
    y[k] = points.y[std::min(i + k, n - 1)];
  }
  visit(i, n - i, Place{hn::LoadU(d, x.data()), hn::LoadU(d, y.data())});
}

template <class D, class T>
HWY_INLINE void store(D d, hn::Vec<D> v, std::size_t size, T* to) {
  if (size == hn::Lanes(d)) return hn::StoreU(v, d, to);
  std::array<T, 16> rest{};
  hn::StoreU(v, d, rest.data());
  std::copy_n(rest.begin(), size, to);
}

/// Whether places are within so many columns and rows.
HWY_INLINE M is_inside(V column, V row, float columns, float rows) {
  const Floats d;
  const auto within = [&](V value, float end) {
    return hn::And(hn::Ge(value, hn::Zero(d)), hn::Lt(value, hn::Set(d, end)));
  };
  return hn::And(within(column, columns), within(row, rows));
}

/// Rounded down; 0 where a lane is not marked, as it may be too large for an integer.
HWY_INLINE I whole(M marked, V value) {
  return hn::ConvertTo(Ints(), hn::IfThenElseZero(marked, value));
}

/// The byte at an address and the next one, as floats.
struct Pair {
  V first, second;
};
HWY_INLINE Pair pair_at(const std::uint8_t* bytes, I at) {
  const Ints ints;
  const Floats d;
  const I word = hn::GatherOffset(ints, reinterpret_cast<const std::int32_t*>(bytes), at);
  const I byte = hn::Set(ints, 255);
  return {hn::ConvertTo(d, hn::And(word, byte)), hn::ConvertTo(d, hn::And(hn::ShiftRight<8>(word), byte))};
}

void look_up_in_vectors(const FieldView& f, const Points& points, const Transform& map_from_points,
                        FieldValues& values) {
  const Floats d;
  const Ints ints;
  constexpr int in_tile = DistanceField::tile_side - 1;
  for_all(points, [&](std::size_t i, std::size_t size, const Place& p) {
    const Place at = moved(map_from_points, p);
    const V scale = hn::Set(d, f.scale);
    const V u = hn::Mul(hn::Sub(at.x, hn::Set(d, f.min_x)), scale);
    const V v = hn::Mul(hn::Sub(at.y, hn::Set(d, f.min_y)), scale);
    const M inside = is_inside(u, v, static_cast<float>(f.columns - 1), static_cast<float>(f.rows - 1));
    const I column = whole(inside, u);
    const I row = whole(inside, v);
    const V a = hn::Sub(u, hn::ConvertTo(d, column));
    const V b = hn::Sub(v, hn::ConvertTo(d, row));
    const I tile =
        hn::Add(hn::Mul(hn::ShiftRight<DistanceField::tile_shift>(row), hn::Set(ints, f.tile_columns)),
                hn::ShiftRight<DistanceField::tile_shift>(column));
    const I place = hn::GatherIndex(ints, reinterpret_cast<const std::int32_t*>(f.tiles), tile);
    const I within = hn::Set(ints, in_tile);
    const I cell =
        hn::Add(hn::Mul(place, hn::Set(ints, static_cast<std::int32_t>(DistanceField::tile_cells))),
                hn::Add(hn::Mul(hn::And(row, within), hn::Set(ints, DistanceField::stride)),
                        hn::And(column, within)));
    const Pair low = pair_at(f.cells, cell);
    const Pair high = pair_at(f.cells + DistanceField::stride, cell);
    const V along_low = hn::Sub(low.second, low.first);
    const V along_high = hn::Sub(high.second, high.first);
    const V below = hn::Add(low.first, hn::Mul(a, along_low));
    const V above = hn::Add(high.first, hn::Mul(a, along_high));
    const V across = hn::Sub(above, below);
    const V step = hn::Set(d, f.step);
    const V slope = hn::Set(d, f.step * f.scale);
    const V distance = hn::Mul(step, hn::Add(below, hn::Mul(b, across)));
    const V along = hn::Add(hn::Mul(hn::Sub(hn::Set(d, 1.0F), b), along_low), hn::Mul(b, along_high));
    store(d, at.x, size, &values.x[i]);
    store(d, at.y, size, &values.y[i]);
    store(d, hn::IfThenElse(inside, distance, hn::Set(d, f.reach)), size, &values.distance[i]);
    store(d, hn::IfThenElseZero(inside, hn::Mul(along, slope)), size, &values.dx[i]);
    store(d, hn::IfThenElseZero(inside, hn::Mul(across, slope)), size, &values.dy[i]);
  });
}

void find_cells_in_vectors(const OccupancyGrid& grid, float scale, const Points& points,
                           const Transform& grid_from_points, std::span<Cell> cells) {
  const Floats d;
  const Ints ints;
  for_all(points, [&](std::size_t i, std::size_t size, const Place& p) {
    const Place at = moved(grid_from_points, p);
    const V column = hn::Mul(at.x, hn::Set(d, scale));
    const V row = hn::Mul(at.y, hn::Set(d, scale));
    const M inside = is_inside(column, row, static_cast<float>(grid.width), static_cast<float>(grid.height));
    std::array<std::int32_t, 16> found{};
    const I cell = hn::Add(hn::Mul(whole(inside, row), hn::Set(ints, grid.width)), whole(inside, column));
    hn::StoreU(hn::IfThenElse(hn::RebindMask(ints, inside), cell, hn::Set(ints, -1)), ints, found.data());
    for (std::size_t k = 0; k < size; ++k)
      cells[i + k] = found[k] < 0 ? Cell::unknown : grid.cells[static_cast<std::size_t>(found[k])];
  });
}

/// ClearanceGrid::clearance() of cells.
HWY_INLINE V clearance_at(const ClearanceView& grid, I column, I row) {
  const Ints ints;
  constexpr int shift = ClearanceGrid::block_shift;
  const I block = hn::Mul(hn::Add(hn::Mul(hn::ShiftRight<shift>(row), hn::Set(ints, grid.block_columns)),
                                  hn::ShiftRight<shift>(column)),
                          hn::Set(ints, static_cast<std::int32_t>(ClearanceGrid::block_bytes)));
  const I within = hn::Set(ints, ClearanceGrid::block_side - 1);
  const I place = hn::Add(hn::ShiftLeft<shift>(hn::And(row, within)), hn::And(column, within));
  // The number of the block, and, behind it, 32 bits of what its cells have more.
  const auto words = [&](const std::uint8_t* bytes) {
    return hn::GatherOffset(ints, reinterpret_cast<const std::int32_t*>(bytes), block);
  };
  const I more = hn::Shr(words(grid.blocks + 1), hn::ShiftLeft<1>(place));
  return hn::ConvertTo(
      Floats(), hn::Add(hn::And(words(grid.blocks), hn::Set(ints, 255)), hn::And(more, hn::Set(ints, 3))));
}

void find_blocked_in_vectors(const ClearanceView& grid, const Point& from, const Points& ends,
                             const Transform& map_from_ends, const Transform& grid_from_map, float margin,
                             std::span<std::uint8_t> blocked) {
  const Floats d;
  const Ints ints;
  const V scale = hn::Set(d, 1.0F / grid.resolution);
  const V from_column = hn::Mul(hn::Set(d, from.x), scale);
  const V from_row = hn::Mul(hn::Set(d, from.y), scale);
  const float outside_columns = outside(hn::GetLane(from_column), grid.width);
  const float outside_rows = outside(hn::GetLane(from_row), grid.height);
  for_all(ends, [&](std::size_t i, std::size_t size, const Place& p) {
    const Place to = moved(grid_from_map, moved(map_from_ends, p));
    const V dx = hn::Sub(to.x, hn::Set(d, from.x));
    const V dy = hn::Sub(to.y, hn::Set(d, from.y));
    const V length = hn::Sqrt(hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy)));
    const V end =
        hn::Min(hn::Mul(hn::Sub(length, hn::Set(d, margin)), scale), hn::Set(d, ClearanceGrid::farthest));
    const V columns = hn::Div(dx, length);
    const V rows = hn::Div(dy, length);
    V t = hn::Set(d, 0.5F);
    M is_on_way = hn::Gt(length, hn::Zero(d));
    // A beam from beyond the grid begins a cell or two before the first one that it meets, if it meets any.
    const auto enter = [&](float beyond, V along) {
      if (beyond == 0.0F) return;
      const V entry = hn::Div(hn::Set(d, -beyond), along);
      is_on_way = hn::And(is_on_way, hn::Gt(entry, hn::Zero(d)));
      t = hn::Max(t, hn::Sub(hn::Floor(entry), hn::Set(d, 1.0F)));
    };
    enter(outside_columns, columns);
    enter(outside_rows, rows);
    is_on_way = hn::And(is_on_way, hn::Le(t, end));
    M was_inside = hn::Lt(t, hn::Zero(d));
    M is_blocked = was_inside;
    while (!hn::AllFalse(d, is_on_way)) {
      const V column = hn::Add(from_column, hn::Mul(t, columns));
      const V row = hn::Add(from_row, hn::Mul(t, rows));
      const M inside = hn::And(
          is_on_way, is_inside(column, row, static_cast<float>(grid.width), static_cast<float>(grid.height)));
      is_on_way = hn::AndNot(hn::AndNot(inside, was_inside), is_on_way);
      was_inside = inside;
      const V clearance = hn::IfThenElse(
          inside, clearance_at(grid, whole(inside, column), whole(inside, row)), hn::Set(d, 1.0F));
      const M met = hn::And(is_on_way, hn::Eq(clearance, hn::Zero(d)));
      is_blocked = hn::Or(is_blocked, met);
      t = hn::Add(t, hn::Max(hn::Set(d, 0.5F), hn::Sub(clearance, hn::Set(d, 1.0F))));
      is_on_way = hn::And(hn::AndNot(met, is_on_way), hn::Le(t, end));
    }
    std::array<std::int32_t, 16> marks{};
    hn::StoreU(hn::VecFromMask(ints, hn::RebindMask(ints, is_blocked)), ints, marks.data());
    for (std::size_t k = 0; k < size; ++k) blocked[i + k] = marks[k] != 0 ? 1 : 0;
  });
}

}  // namespace
}  // namespace glocal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace glocal {

HWY_EXPORT(look_up_in_vectors);
HWY_EXPORT(find_cells_in_vectors);
HWY_EXPORT(find_blocked_in_vectors);

void look_up(const FieldView& field, const Points& points, const Transform& map_from_points,
             FieldValues& values) {
  HWY_DYNAMIC_DISPATCH(look_up_in_vectors)(field, points, map_from_points, values);
}

void find_cells(const OccupancyGrid& grid, float scale, const Points& points,
                const Transform& grid_from_points, std::span<Cell> cells) {
  HWY_DYNAMIC_DISPATCH(find_cells_in_vectors)(grid, scale, points, grid_from_points, cells);
}

void find_blocked(const ClearanceView& clearance, const Point& from, const Points& ends,
                  const Transform& map_from_ends, const Transform& grid_from_map, float margin,
                  std::span<std::uint8_t> blocked) {
  HWY_DYNAMIC_DISPATCH(find_blocked_in_vectors)
  (clearance, from, ends, map_from_ends, grid_from_map, margin, blocked);
}

}  // namespace glocal
#endif
