#include "matchers/box_search/best_places.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace glocal {

void BestOfCell::take_in(const BestOfCell& other) {
  if (bound == 0 || other.best.is_better_than(best)) best = other.best;
  bound = std::max(bound, other.bound);
}

RobotCells::RobotCells(const Pose2& robot_at_zero, double height_at_zero, double cell, double distance,
                       double rotation)
    : robot_at_zero_(robot_at_zero),
      height_at_zero_(height_at_zero),
      cell_(cell),
      binning_{distance / std::numbers::sqrt2, square_parts_of_a_turn(rotation)} {}

RobotCell RobotCells::of(const Box& box) const {
  const double height = height_at_zero_ + cell_ * box.layer;
  return {binning_.cell_of({robot_at_zero_.x + cell_ * box.column, robot_at_zero_.y + cell_ * box.row,
                            robot_at_zero_.theta}),
          static_cast<std::int64_t>(std::floor(height / binning_.side))};
}

void BestPlaces::add(const BestOfCells& found) {
  for (const auto& [cell, place] : found) {
    if (place.bound >= least_) places_[cell].take_in(place);
  }
}

std::size_t keep_best(BestOfCells& places, std::size_t most) {
  if (places.size() < most) return 0;
  std::vector<std::size_t> bounds;
  for (const auto& [cell, place] : places) bounds.push_back(place.bound);
  const auto last = bounds.begin() + static_cast<std::ptrdiff_t>(most) - 1;
  std::nth_element(bounds.begin(), last, bounds.end(), std::greater<>());
  std::erase_if(places, [&](const auto& entry) { return entry.second.bound < *last; });
  return *last;
}

void BestPlaces::raise() {
  const std::size_t last = keep_best(places_, most_);
  if (last > 0) bar_ = last + 1;
}

std::vector<BestOfCell> BestPlaces::falling(bool is_grid) const {
  std::vector<BestOfCell> falling;
  for (const auto& [cell, place] : places_) falling.push_back(place);
  std::stable_sort(falling.begin(), falling.end(), [&](const BestOfCell& a, const BestOfCell& b) {
    return is_grid ? a.best.is_better_than(b.best) : a.bound > b.bound;
  });
  if (falling.size() > most_) falling.resize(most_);
  return falling;
}

}  // namespace glocal
