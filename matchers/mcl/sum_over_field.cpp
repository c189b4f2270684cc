#include "matchers/mcl/sum_over_field.hpp"

#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matchers/mcl/sum_over_field.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace glocal::mcl::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// A pose in each lane. Products are added without fusing them, so that all instruction sets round alike.
void sum_over_field_in_vectors(const FieldCells& field, const Points& points, const MotionBatch& motions,
                               std::size_t size, float* sums) {
  using Poses = hn::CappedTag<float, 16>;
  const Poses d;
  const hn::Rebind<std::int32_t, Poses> ints;
  const auto scale = hn::Set(d, field.scale);
  const auto columns = hn::Set(ints, field.columns);
  const auto clamped = [&](auto value, int cells) {
    // What is no number, too, goes to the first cell.
    const auto positive = hn::IfThenElseZero(hn::Ge(value, hn::Zero(d)), value);
    return hn::Min(hn::ConvertTo(ints, positive), hn::Set(ints, cells - 1));
  };
  for (std::size_t i = 0; i < size; i += hn::Lanes(d)) {
    const auto c = hn::Mul(hn::Load(d, &motions.cosine[i]), scale);
    const auto s = hn::Mul(hn::Load(d, &motions.sine[i]), scale);
    const auto x0 = hn::Mul(hn::Sub(hn::Load(d, &motions.x[i]), hn::Set(d, field.min_x)), scale);
    const auto y0 = hn::Mul(hn::Sub(hn::Load(d, &motions.y[i]), hn::Set(d, field.min_y)), scale);
    auto sum = hn::Zero(d);
    for (std::size_t k = 0; k < points.size(); ++k) {
      const auto x = hn::Set(d, points.x[k]);
      const auto y = hn::Set(d, points.y[k]);
      const auto column = clamped(hn::Add(hn::Sub(hn::Mul(c, x), hn::Mul(s, y)), x0), field.columns);
      const auto row = clamped(hn::Add(hn::Add(hn::Mul(s, x), hn::Mul(c, y)), y0), field.rows);
      sum = hn::Add(sum, hn::GatherIndex(d, field.cells, hn::Add(hn::Mul(row, columns), column)));
    }
    hn::StoreU(sum, d, sums + i);
  }
}

}  // namespace
}  // namespace glocal::mcl::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace glocal::mcl {

HWY_EXPORT(sum_over_field_in_vectors);

void sum_over_field(const FieldCells& field, const Points& points, const MotionBatch& map_from_points,
                    std::size_t size, float* sums) {
  HWY_DYNAMIC_DISPATCH(sum_over_field_in_vectors)(field, points, map_from_points, size, sums);
}

}  // namespace glocal::mcl
#endif
