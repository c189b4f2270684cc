#include "sources/simulation/planned_drive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "glocal/error.hpp"
#include "sources/ros_map/ros_map.hpp"
#include "sources/simulation/added_things.hpp"
#include "sources/simulation/clear_cells.hpp"
#include "sources/simulation/world_grid.hpp"

namespace glocal::simulation {
namespace {

constexpr double most_observations = 1e6;

/// Adds equal steps from the last pose to `target`, none larger than allowed by `size` of the largest.
void add_steps(std::vector<Pose2>& poses, const Pose2& target, double size) {
  if (static_cast<double>(poses.size()) + size > most_observations) {
    throw ConfigError("",
                      "simulation: the drive has more than a million observations; raise step_length and "
                      "step_turn_deg, or lower tour_legs");
  }
  const Pose2 from = poses.back();
  // A remainder that is only rounding makes no step of its own.
  const int steps = static_cast<int>(std::ceil(size - 1e-9));
  for (int i = 1; i <= steps; ++i)
    poses.push_back(pose_between(from, target, static_cast<double>(i) / steps));
}

double heading(const Position& from, const Position& to) {
  return std::atan2(to[1] - from[1], to[0] - from[0]);
}

/// Turns towards a place, then drives there; no step is longer or turns more than the parameters allow.
void drive_to(const Position& place, const DriveParams& params, std::vector<Pose2>& poses) {
  const Pose2 from = poses.back();
  const double theta = heading({from.x, from.y}, place);
  const Pose2 turned{from.x, from.y, theta};
  add_steps(poses, turned, rotation_between(from, turned) / radians(params.step_turn_deg));
  const Pose2 target{place[0], place[1], theta};
  add_steps(poses, target, distance(from, target) / params.step_length);
}

Pose2 pose_after(const Kidnapping& kidnapping) {
  return {kidnapping.to[0], kidnapping.to[1], wrap_angle(radians(kidnapping.heading_deg))};
}

/// The file that says where to drive.
std::string file_of(const DriveParams& params) {
  return params.world.resolved.string();
}

/// A robot cannot drive on through walls.
void check_where_it_is_carried(const Ways& ways, const DriveParams& params) {
  std::vector<Fault> faults;
  for (std::size_t i = 0; i < params.kidnappings.size(); ++i) {
    const std::vector<double>& to = params.kidnappings[i].to;
    const std::string obstacle = ways.obstacle_from({to[0], to[1]});
    if (!obstacle.empty())
      faults.push_back({file_of(params), 0, 0, fmt::format("kidnappings[{}]: {}", i, obstacle)});
  }
  if (!faults.empty()) throw ConfigError(std::move(faults));
}

/// Nor can it be carried away from a drive that is over.
void check_when_it_is_carried(const Route& route, const DriveParams& params, double driven) {
  std::vector<Fault> faults;
  for (std::size_t i = route.carried.size(); i < params.kidnappings.size(); ++i) {
    faults.push_back(
        {file_of(params), 0, 0,
         fmt::format("kidnappings[{}]: the drive is over after {:.1f} m; lower after_m from {} m, "
                     "or drive farther",
                     i, driven, params.kidnappings[i].after_m)});
  }
  if (!faults.empty()) throw ConfigError(std::move(faults));
}

Rng stream_of(DriveStream stream, std::uint64_t seed) {
  return Rng(seed).stream({static_cast<std::uint64_t>(stream)});
}

/// Between the kidnappings.
std::vector<std::vector<Position>> ways_of(const Route& route) {
  std::vector<std::vector<Position>> ways(1);
  for (std::size_t i = 0; i < route.poses.size(); ++i) {
    if (std::binary_search(route.carried.begin(), route.carried.end(), i)) ways.emplace_back();
    ways.back().push_back({route.poses[i].x, route.poses[i].y});
  }
  return ways;
}

std::vector<Position> places_on(const Route& route) {
  std::vector<Position> places;
  for (const Pose2& pose : route.poses) places.push_back({pose.x, pose.y});
  return places;
}

/// People walk where they like, and boxes stand where neither they nor the robot come by.
void add_things(PlannedDrive& drive, const OccupancyGrid& grid, const ClearRegion& region,
                const DriveParams& params, std::uint64_t seed) {
  const std::vector<Walker> people =
      drawn_people(params.people, region, stream_of(DriveStream::people, seed));
  std::vector<std::vector<Position>> ways = ways_of(drive.route);
  for (const Walker& walker : people) ways.push_back(walker.points);
  const std::vector<Rectangle> boxes = drawn_boxes(params.boxes, grid, region, ways, params.clearance,
                                                   stream_of(DriveStream::boxes, seed), file_of(params));
  drive.world.people.insert(drive.world.people.end(), people.begin(), people.end());
  drive.world.rectangles.insert(drive.world.rectangles.end(), boxes.begin(), boxes.end());
}

/// A cloud is for those who see it, and for what must not stand in it.
PlannedDrive drive_in_world(const DriveParams& params, const SourceSetup& setup, bool sees_cloud) {
  setup.note_input(params.world.resolved);
  PlannedDrive drive = drive_in(read_world(params.world.resolved), params, setup.seed);
  const bool has_things = params.boxes > 0 || params.people > 0;
  const bool has_cloud = !drive.world.cloud.text.empty();
  if (has_cloud && (has_things || sees_cloud)) {
    setup.note_input(drive.world.cloud.resolved);
    drive.cloud = voxels_of(drive.world);
  }
  if (!has_things) return drive;
  const OccupancyGrid grid =
      has_cloud ? floor_near(places_on(drive.route), drive.world, *drive.cloud, file_of(params))
                : reality_of(drive.world);
  const ClearRegion region = checked_region(ClearRegion::largest(grid, clear_cells(grid, params.clearance)),
                                            params.clearance, file_of(params));
  add_things(drive, grid, region, params, setup.seed);
  return drive;
}

/// The places that a drive is told.
void make_relative(LaserDriveParams& params, const Vector3& origin) {
  const auto make_place_relative = [&](auto& place) {
    place[0] -= origin.x();
    place[1] -= origin.y();
  };
  for (Position& place : params.way_points) make_place_relative(place);
  for (Kidnapping& kidnapping : params.kidnappings) make_place_relative(kidnapping.to);
}

PlannedDrive drive_in_map(LaserDriveParams params, const SourceSetup& setup) {
  params.world = params.map;  // Where it drives, as faults tell.
  MapData map = ros_map::RosMap({params.map}, setup).load();
  make_relative(params, map.origin);
  PlannedDrive drive{{}, std::move(map.grid), {}, {}, map.origin};
  const OccupancyGrid& grid = *drive.map;
  const Rng rng = stream_of(DriveStream::tour, setup.seed);
  const MapWays ways =
      params.way_points.empty()
          ? MapWays(grid, params.clearance, params.tour_legs, rng, file_of(params), map.origin)
          : MapWays(grid, params.clearance, params.way_points, file_of(params), map.origin);
  drive.route = route_of(ways, params, rng);
  add_things(drive, grid, ways.region(), params, setup.seed);
  return drive;
}

}  // namespace

Pose2 pose_between(const Pose2& from, const Pose2& to, double share) {
  return {from.x + share * (to.x - from.x), from.y + share * (to.y - from.y),
          wrap_angle(from.theta + share * wrap_angle(to.theta - from.theta))};
}

Route route_of(const Ways& ways, const DriveParams& params, Rng rng) {
  check_where_it_is_carried(ways, params);
  Itinerary itinerary = ways.itinerary(params.tour_legs, rng);
  Position at = ways.places()[0];
  const Position first_corner = ways.between(at, ways.places()[1]).front();
  Route route{{{at[0], at[1], heading(at, first_corner)}}, {}};
  double driven = 0.0;
  auto kidnapping = params.kidnappings.begin();
  while (const std::optional<Position> place = itinerary.next()) {
    const std::size_t first_new = route.poses.size();
    for (const Position& corner : ways.between(at, *place)) drive_to(corner, params, route.poses);
    at = *place;
    for (std::size_t i = first_new; i < route.poses.size(); ++i) {
      driven += distance(route.poses[i - 1], route.poses[i]);
      if (kidnapping == params.kidnappings.end() || driven < kidnapping->after_m) continue;
      route.poses.resize(i + 1);
      route.carried.push_back(i + 1);
      at = {kidnapping->to[0], kidnapping->to[1]};
      route.poses.push_back(pose_after(*kidnapping++));
      ways.go_on_from(at, itinerary);
      break;
    }
  }
  check_when_it_is_carried(route, params, driven);
  return route;
}

PlannedDrive drive_in(World world, const DriveParams& params, std::uint64_t seed) {
  PlannedDrive drive{std::move(world), {}, {}, {}};
  drive.route = route_of(WorldWays(drive.world), params, stream_of(DriveStream::tour, seed));
  return drive;
}

PlannedDrive planned_drive(const LaserDriveParams& params, const SourceSetup& setup) {
  return params.map.text.empty() ? drive_in_world(params, setup, false) : drive_in_map(params, setup);
}

PlannedDrive planned_drive(const LidarDriveParams& params, const SourceSetup& setup) {
  return drive_in_world(params, setup, true);
}

}  // namespace glocal::simulation
