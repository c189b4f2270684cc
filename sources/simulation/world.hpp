// A simulated world as its YAML file describes it. What is on the map and what is there in reality are kept
// apart.
#pragma once

#include <filesystem>
#include <vector>

#include "glocal/params.hpp"
#include "sources/simulation/shapes.hpp"

namespace glocal::simulation {

/// Where a thing is: on the map, in reality, or (as a rule) both.
struct Presence {
  bool on_map = true;
  bool in_reality = true;
};

/// Height of what says nothing of its own, m.
inline constexpr double usual_height = 2.5;

/// Straight walls from point to point.
struct Wall {
  std::vector<Position> points;
  bool closed = false;
  double height = usual_height;
  Presence presence = {};
};
void describe(ParamVisitor& v, Wall& p);

/// The outline of a box, a table, …
struct Rectangle {
  std::vector<double> centre;
  std::vector<double> size;
  double angle_deg = 0.0;
  double height = usual_height;
  Presence presence = {};
};
void describe(ParamVisitor& v, Rectangle& p);

/// The outline of a pillar, a chair leg, …
struct RoundThing {
  std::vector<double> centre;
  double radius = 0.0;
  double height = usual_height;
  Presence presence = {};
};
void describe(ParamVisitor& v, RoundThing& p);

/// Somebody who walks from point to point, then back again, and so on; never on the map.
struct Walker {
  std::vector<Position> points;
  double speed = 0.5;
  double radius = 0.2;
  double height = 1.75;
};
void describe(ParamVisitor& v, Walker& p);

/// A part of the map that says nothing.
struct UnmappedArea {
  std::vector<Position> corners;
};
void describe(ParamVisitor& v, UnmappedArea& p);

/// Metres; x to the right, y up, from (0, 0) to `size`. In space z is up; things stand on the floor.
struct World {
  std::vector<double> size;
  double floor = 0.0;
  double ceiling = 0.0;
  FilePath cloud;
  double cloud_voxel_size = 0.1;
  std::vector<Wall> walls;
  std::vector<Rectangle> rectangles;
  std::vector<RoundThing> circles;
  std::vector<Walker> people;
  std::vector<UnmappedArea> unmapped;
  std::vector<Position> free_from;
  std::vector<Position> way_points;
};
void describe(ParamVisitor& v, World& p);

/// Reads a world. Throws ConfigError with all faults; among them way points outside the world, or a way
/// through a wall.
[[nodiscard]] World read_world(const std::filesystem::path& file);

/// Whether a robot can drive straight from place to place: nothing is in its way or too near to where it
/// turns, and the way has a length.
[[nodiscard]] bool is_free_way(const Shapes& reality, const Position& from, const Position& to);

/// What the map shows.
[[nodiscard]] Shapes shapes_on_map(const World& world);

/// What does not move in reality.
[[nodiscard]] Shapes shapes_in_reality(const World& world);

/// Where people are `time` seconds after the start.
[[nodiscard]] std::vector<Circle> people_at(const World& world, double time);

}  // namespace glocal::simulation
