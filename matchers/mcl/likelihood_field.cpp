#include "matchers/mcl/likelihood_field.hpp"

#include <algorithm>
#include <cmath>

#include "matchers/mcl/sum_over_field.hpp"

namespace glocal::mcl {

double likelihood_of_distance(double distance, const LikelihoodFieldRule& rule) {
  const double deviations = std::min(distance, rule.max_distance) / rule.sigma_hit;
  return rule.z_hit * std::exp(-0.5 * deviations * deviations) + rule.z_rand / rule.max_range;
}

LikelihoodField::LikelihoodField(const GlobalMap& map, const LikelihoodFieldRule& rule,
                                 const std::function<double(double likelihood)>& term)
    : scale_(static_cast<float>(1.0 / rule.distance_cell)) {
  const Points& points = map.points();
  const DistanceField distances(points, rule.distance_cell, rule.max_distance);
  const auto [min_x, max_x] = std::minmax_element(points.x.begin(), points.x.end());
  const auto [min_y, max_y] = std::minmax_element(points.y.begin(), points.y.end());
  // Two cells more than the distances reach, so that those at the border are far from all points.
  const double margin = rule.max_distance + 2.0 * rule.distance_cell;
  min_x_ = static_cast<float>(*min_x - margin);
  min_y_ = static_cast<float>(*min_y - margin);
  columns_ = static_cast<int>(std::ceil((double{*max_x} - *min_x + 2.0 * margin) / rule.distance_cell));
  rows_ = static_cast<int>(std::ceil((double{*max_y} - *min_y + 2.0 * margin) / rule.distance_cell));
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
  sum_over_field({min_x_, min_y_, scale_, columns_, rows_, cells_.data()}, ends, map_from_robot, size,
                 sums.data());
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
