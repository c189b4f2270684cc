#include "matchers/common/triangle.hpp"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matchers/common/triangle.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
#include <hwy/highway.h>

#include "matchers/common/put_chosen-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace glocal::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::ScalableTag<float>;
using Words = hn::ScalableTag<std::uint32_t>;
using Ints = hn::ScalableTag<std::int32_t>;
using VF = hn::Vec<Floats>;
using VW = hn::Vec<Words>;
using Mask = hn::Mask<Floats>;

// Products are added without fusing them, so that all instruction sets round alike.

/// Corners of as many triangles as a vector has lanes.
struct Corners {
  VF ax, ay, bx, by, cx, cy;
};

HWY_INLINE Corners gather(const Points& points, const TripleBatch& batch, std::size_t i) {
  const Floats d;
  const Ints ints;
  const auto index = [&](const TripleBatch::Column& column) {
    return hn::BitCast(ints, hn::Load(Words(), &column[i]));
  };
  const auto a = index(batch.first);
  const auto b = index(batch.second);
  const auto c = index(batch.third);
  const float* x = points.x.data();
  const float* y = points.y.data();
  return {hn::GatherIndex(d, x, a), hn::GatherIndex(d, y, a), hn::GatherIndex(d, x, b),
          hn::GatherIndex(d, y, b), hn::GatherIndex(d, x, c), hn::GatherIndex(d, y, c)};
}

/// Squared sides, and twice the signed area.
struct Sides {
  VF ab, bc, ca, area;
};

HWY_INLINE Sides sides_of(const Corners& t) {
  const VF abx = hn::Sub(t.bx, t.ax);
  const VF aby = hn::Sub(t.by, t.ay);
  const VF bcx = hn::Sub(t.cx, t.bx);
  const VF bcy = hn::Sub(t.cy, t.by);
  const VF cax = hn::Sub(t.ax, t.cx);
  const VF cay = hn::Sub(t.ay, t.cy);
  const auto square = [](VF u, VF v) { return hn::Add(hn::Mul(u, u), hn::Mul(v, v)); };
  return {square(abx, aby), square(bcx, bcy), square(cax, cay),
          hn::Sub(hn::Mul(aby, cax), hn::Mul(abx, cay))};
}

/// How to name a triangle's corners anew: first b and c change places where it runs clockwise, then the
/// corners go round until the longest side is ab.
struct Order {
  Mask clockwise, ab_longest, bc_longest;
};

HWY_INLINE Order order_of(Sides& s, VF longest) {
  const Floats d;
  const Mask clockwise = hn::Lt(s.area, hn::Zero(d));
  const VF ab = hn::IfThenElse(clockwise, s.ca, s.ab);
  s.ca = hn::IfThenElse(clockwise, s.ab, s.ca);
  s.ab = ab;
  return {clockwise, hn::Eq(s.ab, longest), hn::Eq(s.bc, longest)};
}

/// What comes first, of what belongs to a, b and c (or to ab, bc and ca).
HWY_INLINE VF first_of(const Order& o, VF a, VF b, VF c) {
  return hn::IfThenElse(o.ab_longest, a, hn::IfThenElse(o.bc_longest, b, c));
}

HWY_INLINE VF longest_of(const Sides& s) {
  return hn::Max(hn::Max(s.ab, s.bc), s.ca);
}

/// A side length in relation cells, and the neighbouring cell that is nearer.
struct Cells {
  VW own, nearer;
};

HWY_INLINE Cells cells_of(VF square, VF cells_per_metre) {
  const Floats d;
  const Words words;
  const Ints ints;
  const VF length = hn::Mul(hn::Sqrt(square), cells_per_metre);
  const auto cell = hn::ConvertTo(ints, length);
  const VF fraction = hn::Sub(length, hn::ConvertTo(d, cell));
  const VW own = hn::BitCast(words, cell);
  const auto lower = hn::And(hn::Lt(fraction, hn::Set(d, 0.5F)), hn::Ge(length, hn::Set(d, 1.0F)));
  const VW one = hn::Set(words, 1U);
  return {own, hn::IfThenElse(hn::RebindMask(words, lower), hn::Sub(own, one), hn::Add(own, one))};
}

void find_relations_in_vectors(const Points& points, const TripleBatch& batch, const TriangleRule& rule,
                               bool neighbours, RelationBatch& relations) {
  const Floats d;
  const Words words;
  const auto square = [](double value) { return static_cast<float>(value) * static_cast<float>(value); };
  const VF min_side = hn::Set(d, square(rule.min_side));
  const VF max_side = hn::Set(d, square(rule.max_side));
  const VF min_height = hn::Set(d, square(rule.min_height));
  const VF cells_per_metre = hn::Set(d, static_cast<float>(1.0 / rule.cell));
  const VF tiny = hn::Set(d, std::numeric_limits<float>::min());

  for (std::size_t i = 0; i < batch.size; i += hn::Lanes(d)) {
    Sides s = sides_of(gather(points, batch, i));
    const VF longest = longest_of(s);
    const VF shortest = hn::Min(hn::Min(s.ab, s.bc), s.ca);
    Mask admitted = hn::And(hn::Ge(shortest, min_side), hn::Lt(longest, max_side));
    admitted = hn::And(admitted, hn::Ge(hn::Mul(s.area, s.area), hn::Mul(min_height, longest)));
    admitted = hn::And(admitted, hn::Gt(shortest, tiny));
    admitted = hn::And(admitted, hn::FirstN(d, batch.size - i));
    if (hn::AllFalse(d, admitted)) continue;  // many vectors of a large map end here

    const Order order = order_of(s, longest);
    const Cells a = cells_of(longest, cells_per_metre);
    const Cells b = cells_of(first_of(order, s.bc, s.ca, s.ab), cells_per_metre);
    const Cells c = cells_of(first_of(order, s.ca, s.ab, s.bc), cells_per_metre);
    const VW numbers = hn::Load(words, &batch.numbers[i]);
    const auto store = [&](VW first, VW second, VW third) {
      const VW relation = hn::Or(
          hn::Or(hn::ShiftLeft<2 * relation_side_bits>(first), hn::ShiftLeft<relation_side_bits>(second)),
          third);
      const auto mask = hn::RebindMask(words, admitted);
      put_chosen(words, numbers, mask, &relations.numbers[relations.size]);
      relations.size += put_chosen(words, relation, mask, &relations.relations[relations.size]);
    };
    store(a.own, b.own, c.own);
    if (!neighbours) continue;
    store(a.own, b.own, c.nearer);
    store(a.own, b.nearer, c.own);
    store(a.own, b.nearer, c.nearer);
    store(a.nearer, b.own, c.own);
    store(a.nearer, b.own, c.nearer);
    store(a.nearer, b.nearer, c.own);
    store(a.nearer, b.nearer, c.nearer);
  }
}

/// The corners in the order of relations.
HWY_INLINE Corners ordered(const Corners& t) {
  Sides s = sides_of(t);
  const Order order = order_of(s, longest_of(s));
  const VF bx = hn::IfThenElse(order.clockwise, t.cx, t.bx);
  const VF by = hn::IfThenElse(order.clockwise, t.cy, t.by);
  const VF cx = hn::IfThenElse(order.clockwise, t.bx, t.cx);
  const VF cy = hn::IfThenElse(order.clockwise, t.by, t.cy);
  return {first_of(order, t.ax, bx, cx), first_of(order, t.ay, by, cy), first_of(order, bx, cx, t.ax),
          first_of(order, by, cy, t.ay), first_of(order, cx, t.ax, bx), first_of(order, cy, t.ay, by)};
}

void least_squares_motions_in_vectors(const Points& from_points, const TripleBatch& from,
                                      const Points& to_points, const TripleBatch& to, MotionBatch& motions) {
  const Floats d;
  const VF third = hn::Set(d, 1.0F / 3.0F);
  const auto mean = [&](VF a, VF b, VF c) { return hn::Mul(hn::Add(hn::Add(a, b), c), third); };
  const auto dot = [](VF ax, VF ay, VF bx, VF by) { return hn::Add(hn::Mul(ax, bx), hn::Mul(ay, by)); };
  for (std::size_t i = 0; i < from.size; i += hn::Lanes(d)) {
    const Corners f = ordered(gather(from_points, from, i));
    const Corners t = ordered(gather(to_points, to, i));
    const VF fx = mean(f.ax, f.bx, f.cx);
    const VF fy = mean(f.ay, f.by, f.cy);
    const VF tx = mean(t.ax, t.bx, t.cx);
    const VF ty = mean(t.ay, t.by, t.cy);
    // The optimal rotation turns by atan2(sine, cosine) of these sums over the centred corners.
    VF cosine = hn::Zero(d);
    VF sine = hn::Zero(d);
    const auto add_corner = [&](VF from_x, VF from_y, VF to_x, VF to_y) {
      const VF ux = hn::Sub(from_x, fx);
      const VF uy = hn::Sub(from_y, fy);
      const VF vx = hn::Sub(to_x, tx);
      const VF vy = hn::Sub(to_y, ty);
      cosine = hn::Add(cosine, dot(ux, uy, vx, vy));
      sine = hn::Add(sine, hn::Sub(hn::Mul(ux, vy), hn::Mul(uy, vx)));
    };
    add_corner(f.ax, f.ay, t.ax, t.ay);
    add_corner(f.bx, f.by, t.bx, t.by);
    add_corner(f.cx, f.cy, t.cx, t.cy);
    const VF norm = hn::Sqrt(dot(cosine, sine, cosine, sine));
    const Mask turns = hn::Gt(norm, hn::Zero(d));
    const VF c = hn::IfThenElse(turns, hn::Div(cosine, norm), hn::Set(d, 1.0F));
    const VF s = hn::IfThenElse(turns, hn::Div(sine, norm), hn::Zero(d));
    hn::Store(c, d, &motions.cosine[i]);
    hn::Store(s, d, &motions.sine[i]);
    hn::Store(hn::Sub(tx, hn::Sub(hn::Mul(c, fx), hn::Mul(s, fy))), d, &motions.x[i]);
    hn::Store(hn::Sub(ty, hn::Add(hn::Mul(s, fx), hn::Mul(c, fy))), d, &motions.y[i]);
  }
}

}  // namespace
}  // namespace glocal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace glocal {

HWY_EXPORT(find_relations_in_vectors);
HWY_EXPORT(least_squares_motions_in_vectors);

void find_relations(const Points& points, const TripleBatch& batch, const TriangleRule& rule, bool neighbours,
                    RelationBatch& relations) {
  HWY_DYNAMIC_DISPATCH(find_relations_in_vectors)(points, batch, rule, neighbours, relations);
}

void least_squares_motions(const Points& from_points, const TripleBatch& from, const Points& to_points,
                           const TripleBatch& to, MotionBatch& motions) {
  HWY_DYNAMIC_DISPATCH(least_squares_motions_in_vectors)(from_points, from, to_points, to, motions);
}

}  // namespace glocal
#endif
