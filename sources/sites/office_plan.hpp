// A simulated office: its floor plan (rows of rooms on both sides of corridors, and corridors across), what
// stands about in it, and a robot's way through it.
#pragma once

#include <cstddef>
#include <vector>

#include "glocal/rng.hpp"
#include "sources/simulation/world.hpp"

namespace glocal::sites {

inline constexpr double wall_thickness = 0.14;  // m, of walls within the building
inline constexpr double door_width = 0.9;       // m
inline constexpr double pillar_side = 0.45;     // m

/// Part of an axis, m.
struct Span {
  double from = 0.0;
  double to = 0.0;

  [[nodiscard]] double length() const { return to - from; }
  [[nodiscard]] double middle() const { return (from + to) / 2.0; }
};

/// Axes of a part of the building, along those of the world or across them, either way round.
struct Frame {
  simulation::Position origin{};
  simulation::Position x_axis{1.0, 0.0};
  simulation::Position y_axis{0.0, 1.0};

  /// A place (m) in the world's frame.
  [[nodiscard]] simulation::Position at(double x, double y) const {
    return {origin[0] + x * x_axis[0] + y * y_axis[0], origin[1] + x * x_axis[1] + y * y_axis[1]};
  }
};

enum class RoomUse { office, meeting, storage, stairs, niche, hall };

/// How a door stands on the map, and when the robot drives. `none` is a front without a wall.
enum class Door { none, open, shut, opened_since, shut_since };

/// Its frame begins in the middle of its walls, at the corner of the corridor that the door is near; y leads
/// away from the corridor.
struct Room {
  Frame frame;
  double width = 0.0;  ///< m, along the corridor
  double depth = 0.0;  ///< m
  double door = 0.0;   ///< x of the middle of the door, m
  RoomUse use = RoomUse::office;
  Door state = Door::open;
  int style = 0;             ///< Rooms of the same use, size and style have been furnished alike.
  std::size_t corridor = 0;  ///< Index of the corridor it opens to.
  std::size_t wing = 0;      ///< Index of the wing it is in.

  /// How far (m) a robot drives into it; 0 if the door does not let it, on the map and in reality.
  [[nodiscard]] double way_in() const;
};

/// Wings follow one another along x, with cross corridors between them; each has rooms along all corridors.
struct OfficePlan {
  Span x, y;                          ///< Between the middles of the outer walls.
  std::vector<Span> wings;            ///< In x.
  std::vector<Span> cross_corridors;  ///< In x.
  std::vector<Span> corridors;        ///< In y.
  std::vector<Span> rows;             ///< In y: two of each corridor, below and above it.
  std::vector<double> pillars;        ///< Their x; in all walls at the backs of rooms.
  std::vector<Room> rooms;
};

/// A plan for a square of `side` (m, 20 or more). Rooms, corridors and wings are multiples of a module.
[[nodiscard]] OfficePlan office_plan(double side, Rng rng);

/// Walls, doors and pillars.
void add_walls(const OfficePlan& plan, Rng rng, simulation::World& world);

/// How far (m) a robot may be from the middle of a corridor; furniture leaves a way for it.
inline constexpr double lane_offset = 0.1;

/// Puts furniture into all rooms and along all corridors, on the map and in reality. Rooms that are alike get
/// the same furniture, but for some that is missing, stands a little elsewhere, or that only this room has. A
/// part is moved, removed or added after the map was made. Robots' ways into rooms and along corridors stay
/// free.
void furnish(const OfficePlan& plan, Rng rng, simulation::World& world);

/// Way points of a drive of `length` (m): along corridors to places all over the building, and into
/// some of the rooms on the way, and back.
[[nodiscard]] std::vector<simulation::Position> office_tour(const OfficePlan& plan, double length, Rng rng);

}  // namespace glocal::sites
