#include "sources/simulation/ways.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "glocal/error.hpp"
#include "sources/simulation/clear_cells.hpp"

namespace glocal::simulation {

WorldWays::WorldWays(const World& world) : places_(world.way_points), reality_(shapes_in_reality(world)) {}

Itinerary WorldWays::itinerary(int tour_legs, Rng rng) const {
  return {places_, tour_legs, rng};
}

std::vector<Position> WorldWays::between(const Position& /*from*/, const Position& to) const {
  return {to};
}

void WorldWays::go_on_from(const Position& place, Itinerary& itinerary) const {
  itinerary.go_on_near(place);
}

std::string WorldWays::obstacle_from(const Position& place) const {
  Itinerary itinerary(places_, 0, Rng(0));
  itinerary.go_on_near(place);
  const Position next = *itinerary.next();
  if (is_free_way(reality_, place, next)) return "";
  return fmt::format(
      "the way from [{}, {}] to the nearest way point [{}, {}] meets a wall or thing, or has no length; put "
      "the robot down elsewhere",
      place[0], place[1], next[0], next[1]);
}

MapWays::MapWays(const OccupancyGrid& grid, double clearance, const std::vector<Position>& way_points,
                 const std::string& file, const Vector3& origin)
    : grid_(grid),
      origin_(origin),
      clearance_(clearance),
      is_clear_(clear_cells(grid, clearance)),
      region_(ClearRegion::around(way_points.front(), grid, is_clear_)),
      places_(way_points),
      are_drawn_(false) {
  std::vector<Fault> faults;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    std::string why = obstacle_from(places_[i]);
    if (i > 0 && places_[i] == places_[i - 1]) why = "is the same place as the one before; leave it out";
    if (!why.empty()) faults.push_back({file, 0, 0, fmt::format("way_points[{}]: {}", i, why)});
  }
  if (!faults.empty()) throw ConfigError(std::move(faults));
}

MapWays::MapWays(const OccupancyGrid& grid, double clearance, int legs, Rng rng, const std::string& file,
                 const Vector3& origin)
    : grid_(grid),
      origin_(origin),
      clearance_(clearance),
      is_clear_(clear_cells(grid, clearance)),
      region_(checked_region(ClearRegion::largest(grid, is_clear_), clearance, file)),
      places_{region_.draw(rng)},
      are_drawn_(true) {
  while (places_.size() <= static_cast<std::size_t>(legs)) {
    const Position place = region_.draw(rng);
    if (place != places_.back()) places_.push_back(place);
  }
}

/// Drawn places are a tour already.
Itinerary MapWays::itinerary(int tour_legs, Rng rng) const {
  return {places_, are_drawn_ ? 0 : tour_legs, rng};
}

std::vector<Position> MapWays::between(const Position& from, const Position& to) const {
  return region_.way(from, to);
}

void MapWays::go_on_from(const Position& /*place*/, Itinerary& itinerary) const {
  itinerary.go_on();
}

std::string MapWays::obstacle_from(const Position& place) const {
  if (region_.holds(place)) return "";
  const std::string where = text_of(place);
  if (grid_.at(place[0], place[1]) != Cell::free)
    return where + " lies in no free cell of the map; move it onto free space";
  if (is_clear_[*cell_under(place, grid_)] == 0) {
    return fmt::format("{} is nearer than {} m to a cell that is not free; move it, or lower clearance",
                       where, clearance_);
  }
  if (region_.size() == 0) return "";  // the first place is at fault
  return fmt::format("{} cannot be reached from {} with a clearance of {} m; move it, or lower clearance",
                     where, text_of(places_.front()), clearance_);
}

std::string MapWays::text_of(const Position& place) const {
  return fmt::format("[{}, {}]", origin_.x() + place[0], origin_.y() + place[1]);
}

ClearRegion checked_region(ClearRegion region, double clearance, const std::string& file) {
  if (region.size() >= 2) return region;
  throw ConfigError(file,
                    fmt::format("has no two free cells side by side that are {} m away from all that is not "
                                "free; lower clearance, or take another map",
                                clearance));
}

}  // namespace glocal::simulation
