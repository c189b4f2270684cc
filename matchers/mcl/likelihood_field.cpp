#include "matchers/mcl/likelihood_field.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "glocal/error.hpp"
#include "glocal/extent.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matchers/mcl/likelihood_field.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace glocal::mcl::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// For each of the first `size` poses, the sum of the cells that the points fall into. `sums` has room for a
/// whole batch. A pose in each lane; products are added without fusing them, so that all instruction sets
/// round alike.
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

double likelihood_of_distance(double distance, const LikelihoodFieldRule& rule) {
  const double deviations = std::min(distance, rule.max_distance) / rule.sigma_hit;
  return rule.z_hit * std::exp(-0.5 * deviations * deviations) + rule.z_rand / rule.max_range;
}

LikelihoodField::LikelihoodField(const GlobalMap& map, const LikelihoodFieldRule& rule,
                                 const std::function<double(double likelihood)>& term)
    : scale_(static_cast<float>(1.0 / rule.distance_cell)) {
  const Points& points = map.points();
  const DistanceField distances(points, rule.distance_cell, rule.max_distance);
  const Extent along_x = extent_of(points.x), along_y = extent_of(points.y);
  // Two cells more than the distances reach, so that those at the border are far from all points.
  const double margin = rule.max_distance + 2.0 * rule.distance_cell;
  min_x_ = static_cast<float>(along_x.low - margin);
  min_y_ = static_cast<float>(along_y.low - margin);
  const double columns = std::ceil((along_x.length() + 2.0 * margin) / rule.distance_cell);
  const double rows = std::ceil((along_y.length() + 2.0 * margin) / rule.distance_cell);
  constexpr double most_cells = 268435456.0;  // whose numbers take a GiB
  if (!(columns * rows <= most_cells))
    throw ConfigError(
        "", "the map is too large for a likelihood field: it would need more than 1 GiB; cut the map");
  columns_ = static_cast<int>(columns);
  rows_ = static_cast<int>(rows);
  cells_.reserve(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      const float x = min_x_ + (static_cast<float>(column) + 0.5F) / scale_;
      const float y = min_y_ + (static_cast<float>(row) + 0.5F) / scale_;
      const double likelihood = likelihood_of_distance(distances.at(x, y).distance, rule);
      cells_.push_back(static_cast<float>(term(likelihood)));
    }
  }
}

void LikelihoodField::sum(const Points& ends, const MotionBatch& map_from_robot, std::size_t size,
                          Sums& sums) const {
  const FieldCells field{min_x_, min_y_, scale_, columns_, rows_, cells_.data()};
  HWY_DYNAMIC_DISPATCH(sum_over_field_in_vectors)(field, ends, map_from_robot, size, sums.data());
}

float LikelihoodField::at(float x, float y) const {
  const auto cell = [&](float value, float least, int cells) {
    return std::clamp(static_cast<int>((value - least) * scale_), 0, cells - 1);
  };
  const int column = cell(x, min_x_, columns_);
  const int row = cell(y, min_y_, rows_);
  return cells_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                static_cast<std::size_t>(column)];
}

}  // namespace glocal::mcl
#endif
