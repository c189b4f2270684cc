#include "sources/simulation/itinerary.hpp"

#include <algorithm>
#include <cstdint>
#include <set>
#include <utility>

namespace glocal::simulation {
namespace {

std::map<Position, std::vector<std::size_t>> neighbours_of(const std::vector<Position>& way_points) {
  std::map<Position, std::vector<std::size_t>> neighbours;
  std::set<std::pair<Position, Position>> ways;
  const auto add = [&](std::size_t from, std::size_t to) {
    const bool is_new = ways.emplace(way_points[from], way_points[to]).second;
    if (is_new) neighbours[way_points[from]].push_back(to);
  };
  for (std::size_t i = 0; i < way_points.size(); ++i) {
    if (i > 0) add(i, i - 1);
    if (i + 1 < way_points.size()) add(i, i + 1);
  }
  return neighbours;
}

}  // namespace

Itinerary::Itinerary(const std::vector<Position>& way_points, int tour_legs, Rng rng)
    : way_points_(way_points), legs_left_(tour_legs), is_tour_(tour_legs > 0), rng_(rng) {
  if (is_tour_) neighbours_ = neighbours_of(way_points);
}

std::optional<Position> Itinerary::next() {
  if (std::exchange(has_to_get_there_, false)) return way_points_[at_];
  if (is_tour_ ? legs_left_ == 0 : at_ + 1 == way_points_.size()) return std::nullopt;
  at_ = is_tour_ ? next_of_tour() : at_ + 1;
  return way_points_[at_];
}

void Itinerary::go_on_near(const Position& place) {
  const auto nearest =
      std::ranges::min_element(way_points_, {}, [&](const Position& p) { return distance(place, p); });
  at_ = static_cast<std::size_t>(nearest - way_points_.begin());
  from_.reset();
  has_to_get_there_ = true;
}

std::size_t Itinerary::next_of_tour() {
  --legs_left_;
  std::vector<std::size_t> choices = neighbours_.at(way_points_[at_]);
  if (choices.size() > 1) std::erase_if(choices, [&](std::size_t i) { return way_points_[i] == from_; });
  from_ = way_points_[at_];
  return choices[rng_.below(static_cast<std::uint32_t>(choices.size()))];
}

}  // namespace glocal::simulation
