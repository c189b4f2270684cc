#include "matchers/box_search/best_places.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace glocal {

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

void take_in(BestOfCells& places, const RobotCell& cell, const Box& box) {
  const auto [known, is_new] = places.try_emplace(cell, box);
  if (!is_new && box.is_better_than(known->second)) known->second = box;
}

std::size_t keep_best(BestOfCells& places, std::size_t most) {
  if (places.size() < most) return 0;
  std::vector<std::size_t> in_contact;
  for (const auto& [cell, box] : places) in_contact.push_back(box.at_middle);
  const auto last = in_contact.begin() + static_cast<std::ptrdiff_t>(most) - 1;
  std::ranges::nth_element(in_contact, last, std::greater<>());
  std::erase_if(places, [&](const auto& entry) { return entry.second.at_middle < *last; });
  return *last;
}

void BestPlaces::add(const BestOfCells& found) {
  for (const auto& [cell, box] : found) take_in(places_, cell, box);
}

void BestPlaces::raise() {
  bar_ = std::max(bar_, keep_best(places_, most_) + 1);
}

std::vector<Box> BestPlaces::falling() const {
  std::vector<Box> falling;
  for (const auto& [cell, box] : places_) falling.push_back(box);
  std::ranges::stable_sort(falling, &Box::is_better_than);
  if (falling.size() > most_) falling.resize(most_);
  return falling;
}

}  // namespace glocal
