#include "sources/carmen/log_drive.hpp"

#include <algorithm>
#include <cmath>

#include "glocal/error.hpp"

namespace glocal::carmen {
namespace {

/// A logger that writes ROBOTLASER1 lines often writes the same scans as FLASER lines too.
std::vector<CarmenScan> of_laser(std::vector<CarmenScan> scans, const std::string& laser) {
  const auto has = [&](CarmenLaser kind) {
    return std::ranges::any_of(scans, [&](const CarmenScan& s) { return s.laser == kind; });
  };
  CarmenLaser kind = CarmenLaser::rlaser;
  if (laser == "front") kind = has(CarmenLaser::flaser) ? CarmenLaser::flaser : CarmenLaser::robotlaser1;
  std::erase_if(scans, [&](const CarmenScan& s) { return s.laser != kind; });
  return scans;
}

}  // namespace

void describe_frames(ParamVisitor& v, LogParams& p) {
  v.field("path", p.path, {.doc = "CARMEN log; plain, gzip, bzip2 or xz.", .required = true});
  v.field("laser", p.laser,
          {.doc = "Which laser: front (FLASER lines, or ROBOTLASER1 where there are none) or rear (RLASER).",
           .choices = {"front", "rear"}});
  describe_segments(v, p.segments);
  describe_keyframes(v, p.keyframes);
  v.field("max_range", p.max_range,
          {.doc = "Readings from here on count as no return.",
           .unit = "m",
           .above = 0.0,
           .audience = Audience::tuner});
  v.field("laser_yaw_deg", p.laser_yaw_deg,
          {.doc = "Correction added to the direction of every reading.",
           .unit = "deg",
           .min = -180.0,
           .max = 180.0,
           .audience = Audience::expert,
           .formerly = "laser_yaw"});
  require_rising(v, p.segments);
}

void describe(ParamVisitor& v, LogParams& p) {
  describe_frames(v, p);
  v.field("min_range", p.min_range,
          {.doc = "Readings below this are dropped: dirt on the glass, or the robot itself.",
           .unit = "m",
           .min = 0.0,
           .audience = Audience::expert});
  v.field("free_range", p.free_range,
          {.doc = "How far the way of a reading without return is taken to be free (at most max_range); 0: "
                  "not at all. The "
                  "default is what a Sick LMS 200 is rated for on dark surfaces.",
           .unit = "m",
           .min = 0.0,
           .audience = Audience::expert});
  v.require(p.min_range < p.max_range, "min_range", "must be below max_range");
}

std::vector<double> path_lengths(const std::vector<CarmenScan>& scans) {
  std::vector<double> lengths(scans.size(), 0.0);
  for (std::size_t i = 1; i < scans.size(); ++i) {
    lengths[i] = lengths[i - 1] + distance(scans[i - 1].odom_from_robot, scans[i].odom_from_robot);
  }
  return lengths;
}

LogDrive read_log_drive(const LogParams& params) {
  const std::string file = params.path.resolved.string();
  LogDrive drive{of_laser(read_carmen_log(params.path.resolved), params.laser), {}};
  if (drive.scans.empty()) {
    throw ConfigError(file, "has no scan of the " + params.laser + " laser; set laser to " +
                                (params.laser == "front" ? "rear" : "front"));
  }
  const auto places = places_on(params.segments, path_lengths(drive.scans), file, "scan");
  for (std::size_t segment = 0; segment < places.size(); ++segment) {
    const std::size_t first = drive.frames.size();
    for (const std::size_t i : places[segment]) {
      const bool is_used =
          drive.frames.size() == first || is_keyframe(drive.scans[drive.frames.back().scan].odom_from_robot,
                                                      drive.scans[i].odom_from_robot, params.keyframes);
      if (is_used) drive.frames.push_back({i, static_cast<int>(segment)});
    }
  }
  return drive;
}

Scan robot_scan(const CarmenScan& scan, const LogParams& params) {
  const double max_range = std::min(params.max_range, scan.max_range);
  const double free_range = std::min(params.free_range, max_range);
  const Transform robot_from_laser(scan.robot_from_laser);
  Scan out;
  out.origin = robot_from_laser({});
  out.hits.reserve(scan.ranges.size());
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const double range = scan.ranges[i];
    // Readings are in single precision, and so is the limit that they are set to.
    const bool no_return = !std::isfinite(range) || range < 0.0 || range >= static_cast<float>(max_range);
    if (no_return ? free_range <= 0.0 : range < params.min_range) continue;
    const double angle =
        scan.start_angle + static_cast<double>(i) * scan.angle_step + radians(params.laser_yaw_deg);
    const double reach = no_return ? free_range : range;
    const Point end = robot_from_laser(
        {static_cast<float>(reach * std::cos(angle)), static_cast<float>(reach * std::sin(angle)), 0.0F});
    (no_return ? out.free_ends : out.hits).push_back(end);
  }
  return out;
}

}  // namespace glocal::carmen
