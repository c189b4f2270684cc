#include "sources/simulation/drive_params.hpp"

#include <algorithm>

#include "sources/simulation/occupancy_ray.hpp"

namespace glocal::simulation {

void describe(ParamVisitor& v, OdometryParams& p) {
  v.field("yaw_bias_deg_per_m", p.yaw_bias_deg_per_m,
          {.doc = "Constant turn that is measured when driving straight.", .unit = "deg/m"});
  v.field("yaw_noise_deg_per_m", p.yaw_noise_deg_per_m,
          {.doc = "Standard deviation of the turn that is measured when driving straight.",
           .unit = "deg/m",
           .min = 0.0});
}

void describe(ParamVisitor& v, Kidnapping& p) {
  v.field("after_m", p.after_m,
          {.doc = "Way driven before the robot is carried away.", .unit = "m", .min = 0.0, .required = true});
  v.field(
      "to", p.to,
      {.doc =
           "Where the robot is put down, [x, y]; from there it drives to the nearest way point of a world, "
           "or in a map to where it was going.",
       .unit = "m",
       .min_items = 2,
       .max_items = 2,
       .required = true});
  v.field("heading_deg", p.heading_deg,
          {.doc = "Heading of the robot where it is put down.", .unit = "deg", .min = -360.0, .max = 360.0});
}

namespace {

/// What is the same with any sensor; where the robot drives is not.
void describe_drive(ParamVisitor& v, DriveParams& p) {
  v.field("tour_legs", p.tour_legs,
          {.doc = "Number of ways of a random tour: each pair of consecutive way points is a way in both "
                  "directions, and ways meet where way points are equal. 0 drives the way points as they are "
                  "listed. In a map without way points, each way leads to a place that is drawn.",
           .min = 0,
           .max = 100000});
  v.field(
      "clearance", p.clearance,
      {.doc = "In a map the robot keeps so far away from every cell that is not free, and boxes keep so far "
              "away from its way.",
       .unit = "m",
       .min = 0.0,
       .max = 5.0});
  v.field(
      "boxes", p.boxes,
      {.doc = "Number of boxes that have been put there since the map was made: with sides of 0.3 to 1 m, "
              "0.5 to 1.5 m high, drawn on free space off the robot's way.",
       .min = 0,
       .max = 1000});
  v.field("people", p.people,
          {.doc = "Number of people who walk to and fro when the robot drives, each between two places that "
                  "are drawn, at 0.4 to 1.2 m/s; beside those of the world.",
           .min = 0,
           .max = 1000});
  v.field("kidnappings", p.kidnappings,
          {.doc = "Where the robot is carried away, between two observations and unnoticed by odometry."});
  v.field("step_length", p.step_length,
          {.doc = "Largest way from observation to observation.", .unit = "m", .min = 0.001});
  v.field("step_turn_deg", p.step_turn_deg,
          {.doc = "Largest turn from observation to observation.", .unit = "deg", .min = 0.1, .max = 180.0});
  v.field("step_seconds", p.step_seconds,
          {.doc = "Time from observation to observation, in which people walk on.",
           .unit = "s",
           .min = 0.0,
           .max = 3600.0,
           .audience = Audience::expert});
  v.require(std::ranges::is_sorted(p.kidnappings, {}, &Kidnapping::after_m), "kidnappings",
            "must be in rising order of after_m");
}

}  // namespace

void describe(ParamVisitor& v, LaserDriveParams& p) {
  v.field("world", p.world, {.doc = "File that describes the world and the drive."});
  v.field("map", p.map,
          {.doc = "Map of the ROS map server (YAML file) that the robot drives in, in place of a world."});
  v.field("way_points", p.way_points,
          {.doc = "In a map: places to drive to one after the other, [x, y] each, by shortest ways. Without, "
                  "the places of a random tour are drawn.",
           .unit = "m",
           .max_items = 10000});
  describe_drive(v, p);
  v.field("odometry", p.odometry,
          {.doc = "How badly the robot's own motion is measured.", .audience = Audience::expert});
  v.field("laser", p.laser, {.doc = "A planar range finder."});
  v.removed("lidar", "a drive with a lidar is the observation source lidar_simulation");
  const bool has_map = !p.map.text.empty();
  v.require(has_map == p.world.text.empty(), "world",
            "must be given, or map in its place: a robot drives in one of the two");
  v.require(has_map || p.way_points.empty(), "way_points",
            "must be left out where there is a world, whose file has them");
  v.require(p.way_points.size() != 1, "way_points", "must be two or more");
  v.require(!has_map || !p.way_points.empty() || p.tour_legs > 0, "tour_legs",
            "must be 1 or more in a map without way_points");
}

void describe(ParamVisitor& v, LidarDriveParams& p) {
  v.field("world", p.world, {.doc = "File that describes the world and the drive.", .required = true});
  describe_drive(v, p);
  v.field("lidar", p.lidar, {.doc = "A lidar of several beams."});
  v.require(p.lidar.scan_time <= p.step_seconds, "lidar",
            "scan_time must be at most step_seconds: a scan is over before the next one begins");
}

}  // namespace glocal::simulation
