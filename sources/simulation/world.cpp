#include "sources/simulation/world.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "glocal/error.hpp"
#include "glocal/pose2.hpp"
#include "glocal/yaml.hpp"

namespace glocal::simulation {
namespace {

constexpr double lengths = 1000.0;       // m; nothing is larger or farther away
constexpr double least_clearance = 0.1;  // m, between way points and things
// Every way is checked against every thing, and so is every ray.
constexpr std::size_t most_way_points = 10000;
constexpr std::size_t most_things = 10000;

void describe_presence(ParamVisitor& v, Presence& p) {
  v.field("on_map", p.on_map, {.doc = "Whether the map shows it."});
  v.field("in_reality", p.in_reality, {.doc = "Whether it is there when the robot drives."});
}

void describe_height(ParamVisitor& v, double& height) {
  v.field("height", height,
          {.doc = "From the floor to its upper end, as a lidar sees it; a planar laser sees everything.",
           .unit = "m",
           .max = lengths,
           .above = 0.0});
}

void add_wall(Shapes& shapes, const Wall& wall) {
  const std::vector<Position>& points = wall.points;
  for (std::size_t i = 1; i < points.size(); ++i)
    shapes.segments.push_back({points[i - 1], points[i], wall.height});
  if (wall.closed) shapes.segments.push_back({points.back(), points.front(), wall.height});
}

void add_box(Shapes& shapes, const Rectangle& r) {
  const Pose2 world_from_box{r.centre[0], r.centre[1], radians(r.angle_deg)};
  constexpr std::array signs{Position{-0.5, -0.5}, Position{0.5, -0.5}, Position{0.5, 0.5},
                             Position{-0.5, 0.5}};
  Top top{{}, r.height};
  for (std::size_t i = 0; i < signs.size(); ++i) {
    const Pose2 corner = world_from_box * Pose2{signs[i][0] * r.size[0], signs[i][1] * r.size[1], 0.0};
    top.corners[i] = {corner.x, corner.y};
  }
  add_wall(shapes, {{top.corners.begin(), top.corners.end()}, true, r.height});
  shapes.tops.push_back(top);
}

Shapes shapes_where(const World& world, bool Presence::*present) {
  Shapes shapes;
  for (const Wall& wall : world.walls) {
    if (wall.presence.*present) add_wall(shapes, wall);
  }
  for (const Rectangle& rectangle : world.rectangles) {
    if (rectangle.presence.*present) add_box(shapes, rectangle);
  }
  for (const RoundThing& circle : world.circles) {
    if (circle.presence.*present)
      shapes.circles.push_back({{circle.centre[0], circle.centre[1]}, circle.radius, circle.height});
  }
  return shapes;
}

Position walked(const std::vector<Position>& points, double way) {
  const double length = length_of(points);
  if (length <= 0.0) return points.front();
  way = std::fmod(way, 2.0 * length);
  if (way > length) way = 2.0 * length - way;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double leg = distance(points[i - 1], points[i]);
    if (way <= leg && leg > 0.0) return between(points[i - 1], points[i], way / leg);
    way -= leg;
  }
  return points.back();
}

bool inside(const World& world, const std::vector<Position>& points) {
  // Without a usable size, only that is reported. A cloud lies where it lies.
  if (world.size.size() != 2 || !world.cloud.text.empty()) return true;
  return std::ranges::all_of(points, [&](const Position& p) {
    return p[0] >= 0.0 && p[0] <= world.size[0] && p[1] >= 0.0 && p[1] <= world.size[1];
  });
}

/// Corners of walls, rectangles and circles.
std::size_t count_things(const World& world) {
  std::size_t n = world.rectangles.size() + world.circles.size();
  for (const Wall& wall : world.walls) n += wall.points.size();
  return n;
}

/// A robot cannot drive through walls.
std::vector<Fault> check_drive(const World& world, const std::string& file) {
  const Shapes reality = shapes_in_reality(world);
  std::vector<Fault> faults;
  for (std::size_t i = 1; i < world.way_points.size(); ++i) {
    const Position& a = world.way_points[i - 1];
    const Position& b = world.way_points[i];
    if (is_free_way(reality, a, b)) continue;
    faults.push_back(
        {file, 0, 0,
         fmt::format("way_points[{}]: the way from [{}, {}] to [{}, {}] meets a wall or thing, or has no "
                     "length; move the way point or the thing",
                     i, a[0], a[1], b[0], b[1])});
  }
  return faults;
}

/// A field of coordinates within the largest world.
FieldInfo coordinates(Doc doc, std::size_t min_items,
                      std::size_t max_items = std::numeric_limits<std::size_t>::max()) {
  return {.doc = doc,
          .unit = "m",
          .min = -lengths,
          .max = lengths,
          .min_items = min_items,
          .max_items = max_items,
          .required = true};
}

/// A field of a length and a width.
FieldInfo extent(Doc doc) {
  return {.doc = doc,
          .unit = "m",
          .max = lengths,
          .above = 0.0,
          .min_items = 2,
          .max_items = 2,
          .required = true};
}

}  // namespace

void describe(ParamVisitor& v, Wall& p) {
  v.field("points", p.points, coordinates("Corners, [x, y] each.", 2));
  v.field("closed", p.closed, {.doc = "Whether a wall leads back from the last corner to the first."});
  describe_height(v, p.height);
  describe_presence(v, p.presence);
}

void describe(ParamVisitor& v, Rectangle& p) {
  v.field("centre", p.centre, coordinates("[x, y]", 2, 2));
  v.field("size", p.size, extent("Length and width."));
  v.field("angle_deg", p.angle_deg,
          {.doc = "Direction of the length.", .unit = "deg", .min = -360.0, .max = 360.0});
  describe_height(v, p.height);
  describe_presence(v, p.presence);
}

void describe(ParamVisitor& v, RoundThing& p) {
  v.field("centre", p.centre, coordinates("[x, y]", 2, 2));
  v.field("radius", p.radius,
          {.doc = "Radius of the outline.", .unit = "m", .max = lengths, .above = 0.0, .required = true});
  describe_height(v, p.height);
  describe_presence(v, p.presence);
}

void describe(ParamVisitor& v, Walker& p) {
  v.field("points", p.points, coordinates("Way points, [x, y] each.", 1));
  v.field("speed", p.speed, {.doc = "Speed of the walker.", .unit = "m/s", .min = 0.0});
  v.field("radius", p.radius,
          {.doc = "Radius of the legs, as a laser sees them together.",
           .unit = "m",
           .max = lengths,
           .above = 0.0});
  describe_height(v, p.height);
}

void describe(ParamVisitor& v, UnmappedArea& p) {
  v.field("corners", p.corners, coordinates("Two opposite corners, [x, y] each.", 2, 2));
}

void describe(ParamVisitor& v, World& p) {
  v.field("size", p.size, extent("Extent in x and y; everything lies between [0, 0] and here."));
  v.field("floor", p.floor,
          {.doc = "Height of the floor in space, where the robot drives.",
           .unit = "m",
           .min = -lengths,
           .max = lengths});
  v.field("ceiling", p.ceiling,
          {.doc = "From the floor to the ceiling, as a lidar sees it; 0 is none.",
           .unit = "m",
           .min = 0.0,
           .max = lengths});
  v.field("cloud", p.cloud,
          {.doc = "Cloud of points (PCD, PLY, KITTI or OctoMap's .bt) that is there, too, for a lidar: with "
                  "a floor of its own, and places that may lie outside of size."});
  v.field("cloud_voxel_size", p.cloud_voxel_size,
          {.doc = "Rays end where they enter a cube of this side that holds points of the cloud. The voxels "
                  "of an octree stay as they are.",
           .unit = "m",
           .min = 0.01,
           .max = 10.0});
  v.field("walls", p.walls, {.doc = "Straight walls."});
  v.field("rectangles", p.rectangles, {.doc = "Boxes, tables and the like."});
  v.field("circles", p.circles, {.doc = "Round things."});
  v.field("people", p.people, {.doc = "People who walk about when the robot drives."});
  v.field("unmapped", p.unmapped, {.doc = "Rectangles of which the map says nothing."});
  v.field("free_from", p.free_from,
          coordinates(
              "Places from which free space spreads on the map, up to the walls it shows; [x, y] each.", 1));
  v.field(
      "way_points", p.way_points,
      coordinates(
          "The drive: straight from place to place, turning on the spot; it begins looking to the second.", 2,
          most_way_points));
  v.require(count_things(p) <= most_things, "walls",
            "must have at most 10000 corners, together with the rectangles and circles");
  v.require(inside(p, p.free_from), "free_from", "must lie within size");
  v.require(inside(p, p.way_points), "way_points", "must lie within size");
}

World read_world(const std::filesystem::path& file) {
  ParamsOf<World> world;
  read_yaml(file, world);
  std::vector<Fault> faults = check_drive(world.value, file.string());
  if (!faults.empty()) throw ConfigError(std::move(faults));
  return std::move(world.value);
}

bool is_free_way(const Shapes& reality, const Position& from, const Position& to) {
  const double length = distance(from, to);
  const Position direction{(to[0] - from[0]) / length, (to[1] - from[1]) / length};
  return length > 0.0 && ray_distance(reality, from, direction) > length &&
         std::min(clearance(reality, from), clearance(reality, to)) >= least_clearance;
}

Shapes shapes_on_map(const World& world) {
  return shapes_where(world, &Presence::on_map);
}

Shapes shapes_in_reality(const World& world) {
  return shapes_where(world, &Presence::in_reality);
}

std::vector<Circle> people_at(const World& world, double time) {
  std::vector<Circle> circles;
  for (const Walker& walker : world.people) {
    circles.push_back({walked(walker.points, walker.speed * time), walker.radius, walker.height});
  }
  return circles;
}

}  // namespace glocal::simulation
