#include "sources/itinerary.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace glocal {

std::optional<Position> Itinerary::next() {
  if (has_to_get_there_) {
    has_to_get_there_ = false;
    return way_points_[at_];
  }
  if (is_tour_ ? legs_left_ == 0 : at_ + 1 == way_points_.size()) return std::nullopt;
  at_ = is_tour_ ? next_of_tour() : at_ + 1;
  return way_points_[at_];
}

void Itinerary::go_on_near(const Position& place) {
  const auto distance_to = [&](const Position& p) { return std::hypot(p[0] - place[0], p[1] - place[1]); };
  const auto nearest =
      std::min_element(way_points_.begin(), way_points_.end(),
                       [&](const Position& a, const Position& b) { return distance_to(a) < distance_to(b); });
  at_ = static_cast<std::size_t>(nearest - way_points_.begin());
  from_.reset();
  has_to_get_there_ = true;
}

std::size_t Itinerary::next_of_tour() {
  --legs_left_;
  std::vector<std::size_t> choices = neighbours(at_);
  if (choices.size() > 1) std::erase_if(choices, [&](std::size_t i) { return way_points_[i] == from_; });
  from_ = way_points_[at_];
  return choices[rng_.below(static_cast<std::uint32_t>(choices.size()))];
}

/// Way points that a way leads to, each place once.
std::vector<std::size_t> Itinerary::neighbours(std::size_t at) const {
  std::vector<std::size_t> found;
  const auto add = [&](std::size_t i) {
    const bool repeats = std::any_of(found.begin(), found.end(),
                                     [&](std::size_t other) { return way_points_[other] == way_points_[i]; });
    if (!repeats) found.push_back(i);
  };
  for (std::size_t i = 0; i < way_points_.size(); ++i) {
    if (way_points_[i] != way_points_[at]) continue;
    if (i > 0) add(i - 1);
    if (i + 1 < way_points_.size()) add(i + 1);
  }
  return found;
}

}  // namespace glocal
