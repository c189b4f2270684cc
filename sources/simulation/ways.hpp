// The places a simulated robot drives to, and its ways between them.
#pragma once

#include <string>
#include <vector>

#include "glocal/occupancy_grid.hpp"
#include "glocal/rng.hpp"
#include "sources/simulation/clear_region.hpp"
#include "sources/simulation/itinerary.hpp"
#include "sources/simulation/world.hpp"

namespace glocal::simulation {

/// What a drive through a world and one through a map have in common.
class Ways {
 public:
  virtual ~Ways() = default;

  /// At least two; the drive begins at the first, looking along the way to the second.
  [[nodiscard]] virtual const std::vector<Position>& places() const = 0;
  /// The order of the places.
  [[nodiscard]] virtual Itinerary itinerary(int tour_legs, Rng rng) const = 0;
  /// Where to drive straight to on the way between two places, one after the other; the last is `to`.
  [[nodiscard]] virtual std::vector<Position> between(const Position& from, const Position& to) const = 0;
  /// Says where to go on from a place that the robot was carried to.
  virtual void go_on_from(const Position& place, Itinerary& itinerary) const = 0;
  /// Why a robot cannot go on from a place that it was carried to; empty if it can.
  [[nodiscard]] virtual std::string obstacle_from(const Position& place) const = 0;
};

/// Straight ways between the way points of a world, and to the nearest of them.
class WorldWays final : public Ways {
 public:
  explicit WorldWays(const World& world);

  [[nodiscard]] const std::vector<Position>& places() const override { return places_; }
  [[nodiscard]] Itinerary itinerary(int tour_legs, Rng rng) const override;
  [[nodiscard]] std::vector<Position> between(const Position& from, const Position& to) const override;
  void go_on_from(const Position& place, Itinerary& itinerary) const override;
  [[nodiscard]] std::string obstacle_from(const Position& place) const override;

 private:
  std::vector<Position> places_;
  Shapes reality_;
};

/// Shortest ways through the free cells of a map, a clearance (m) away from all others. A robot that was
/// carried away goes on to where it was going. All places are relative to the map's origin, which messages
/// add. The grid must outlive the ways.
class MapWays final : public Ways {
 public:
  /// Between given places. Throws ConfigError at `file` for places that are not clear, that cannot be reached
  /// from the first, or that follow equal ones.
  MapWays(const OccupancyGrid& grid, double clearance, const std::vector<Position>& way_points,
          const std::string& file, const Vector3& origin = Vector3::Zero());
  /// Between `legs` + 1 places drawn in the largest region. Throws ConfigError at `file` for a map without
  /// two clear cells side by side.
  MapWays(const OccupancyGrid& grid, double clearance, int legs, Rng rng, const std::string& file,
          const Vector3& origin = Vector3::Zero());

  [[nodiscard]] const ClearRegion& region() const { return region_; }

  [[nodiscard]] const std::vector<Position>& places() const override { return places_; }
  [[nodiscard]] Itinerary itinerary(int tour_legs, Rng rng) const override;
  [[nodiscard]] std::vector<Position> between(const Position& from, const Position& to) const override;
  void go_on_from(const Position& place, Itinerary& itinerary) const override;
  [[nodiscard]] std::string obstacle_from(const Position& place) const override;

 private:
  [[nodiscard]] std::string text_of(const Position& place) const;

  const OccupancyGrid& grid_;
  Vector3 origin_;
  double clearance_;
  std::vector<char> is_clear_;
  ClearRegion region_;
  std::vector<Position> places_;
  bool are_drawn_;
};

/// `region`, for drives all over it. Throws ConfigError at `file` if it has less than two cells, which are
/// `clearance` (m) away from all others.
[[nodiscard]] ClearRegion checked_region(ClearRegion region, double clearance, const std::string& file);

}  // namespace glocal::simulation
