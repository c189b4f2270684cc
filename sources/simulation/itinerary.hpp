// Which way point a simulated robot drives to next.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "glocal/rng.hpp"
#include "sources/simulation/shapes.hpp"

namespace glocal::simulation {

/// The way points of a world one after the other; or a random tour, that takes pairs of consecutive way
/// points for ways which meet at equal ones, and turns back only where there is no other.
class Itinerary {
 public:
  /// Begins at the first way point; `tour_legs` 0: in the order in which they are listed.
  Itinerary(const std::vector<Position>& way_points, int tour_legs, Rng rng);

  /// Where to drive to now; none at the end.
  [[nodiscard]] std::optional<Position> next();

  /// Goes on with the way point nearest to a place (of a list's several, the first).
  void go_on_near(const Position& place);

  /// Goes on to where next() has said last.
  void go_on() { has_to_get_there_ = true; }

 private:
  [[nodiscard]] std::size_t next_of_tour();

  std::vector<Position> way_points_;
  /// Of a tour: way points that a way from a place leads to, each place once.
  std::map<Position, std::vector<std::size_t>> neighbours_;
  int legs_left_;
  bool is_tour_;
  Rng rng_;
  std::size_t at_ = 0;
  std::optional<Position> from_;   ///< Where the tour has come from.
  bool has_to_get_there_ = false;  ///< `at_` is still to be driven to.
};

}  // namespace glocal::simulation
