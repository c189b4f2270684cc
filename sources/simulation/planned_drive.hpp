// Where a simulated robot drives, and what is there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "glocal/catalog.hpp"
#include "glocal/occupancy_grid.hpp"
#include "glocal/rng.hpp"
#include "sources/clouds/cloud_voxels.hpp"
#include "sources/simulation/drive_params.hpp"
#include "sources/simulation/ways.hpp"
#include "sources/simulation/world.hpp"

namespace glocal::simulation {

/// Streams of random numbers, one for each thing that is drawn on a drive.
enum class DriveStream : std::uint64_t { laser, odometry, tour, lidar, sway, tilt, people, boxes };

/// The robot's poses, one for each observation.
struct Route {
  std::vector<Pose2> poses;
  std::vector<std::size_t> carried;  ///< Those the robot was carried to, by their indexes.
};

/// A share of the way from pose to pose, as the robot drives it: straight, and turning evenly.
[[nodiscard]] Pose2 pose_between(const Pose2& from, const Pose2& to, double share);

/// Straight from corner to corner of the ways, with turns on the spot. Throws ConfigError for a kidnapping to
/// where the drive cannot go on, or after its end.
[[nodiscard]] Route route_of(const Ways& ways, const DriveParams& params, Rng rng);

/// What is there when a robot drives, and where it drives.
struct PlannedDrive {
  World world;                       ///< Of a map: only what nobody has mapped.
  std::optional<OccupancyGrid> map;  ///< That the robot drives in, if it is one.
  Route route;
  std::optional<clouds::CloudVoxels> cloud;  ///< Of the world, if it has one that somebody asks for.
  Vector3 origin = Vector3::Zero();          ///< Of the map: all places are relative to it.
};

/// Along the way points of a world, with nothing in it but what the world has. Throws ConfigError where
/// route_of() does.
[[nodiscard]] PlannedDrive drive_in(World world, const DriveParams& params, std::uint64_t seed);

/// Throws ConfigError for a faulty world or map, and where route_of(), MapWays, drawn_boxes() and
/// floor_near() do.
[[nodiscard]] PlannedDrive planned_drive(const LaserDriveParams& params, const SourceSetup& setup);
[[nodiscard]] PlannedDrive planned_drive(const LidarDriveParams& params, const SourceSetup& setup);

}  // namespace glocal::simulation
