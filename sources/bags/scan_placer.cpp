#include "sources/bags/scan_placer.hpp"

#include <algorithm>
#include <cmath>

namespace glocal::bags {
namespace {

constexpr double ns_per_s = 1e9;

}  // namespace

void describe_robot_frames(ParamVisitor& v, std::string& odom_frame, std::string& base_frame) {
  v.field("odom_frame", odom_frame, {.doc = "Frame of tf that odometry counts from. Empty: odom."});
  v.field("base_frame", base_frame,
          {.doc = "Frame of the robot. Empty: base_footprint or base_link, or that of the odometry."});
}

void describe_rays(ParamVisitor& v, double& max_range, std::vector<double>& heights, double& voxel_size) {
  v.field("max_range", max_range,
          {.doc = "Readings from here on count as no return; the messages' own limit holds as well.",
           .unit = "m",
           .above = 0.0,
           .audience = Audience::tuner});
  v.field("heights", heights,
          {.doc = "Ends of rays from the first to the second of these heights above the robot's origin are "
                  "used. Empty: all. Where the motion is planar, clouds need this.",
           .unit = "m",
           .max_items = 2});
  v.field("voxel_size", voxel_size,
          {.doc = "Clouds: side of the cubes whose points are replaced by their mean; 0 takes all points.",
           .unit = "m",
           .min = 0.0,
           .max = 100.0,
           .audience = Audience::tuner});
  v.require(max_range > RangeLimits{}.min_range, "max_range",
            "must be above 0.1 m: nearer readings are dropped");
  v.require(heights.empty() || (heights.size() == 2 && heights[0] < heights[1]), "heights",
            "must be two heights, the lower one first");
}

/// Moves the ends of rays to where the robot is at the observation's stamp.
class ScanPlacer::RayMover {
 public:
  /// The sensor's pose in that robot's frame when the first ray was measured and the last one, and these
  /// times, s.
  RayMover(const Pose3& first, const Pose3& last, const std::pair<double, double>& span)
      : motion_(first, last), first_time_(span.first), duration_(span.second - span.first) {}

  [[nodiscard]] Vector3 moved(const Point& p, double time) const {
    return motion_.at(duration_ > 0.0 ? (time - first_time_) / duration_ : 0.0) * as_vector(p);
  }

 private:
  EvenMotion motion_;
  double first_time_, duration_;
};

std::optional<Pose3> ScanPlacer::robot_from_sensor(const std::string& frame, std::int64_t stamp_ns) const {
  if (rule_.robot_from_sensor) return rule_.robot_from_sensor;
  return contents_.robot_from_sensor(frame, stamp_ns, longest_gap_ns);
}

std::optional<ScanPlacer::RayMover> ScanPlacer::mover_of(const Header& header, std::int64_t observation_ns,
                                                         const std::pair<double, double>& span) const {
  const auto sensor_at = [&](double time) -> std::optional<Pose3> {
    const std::int64_t stamp = header.stamp_ns + nanoseconds(time);
    const auto then_from_sensor = robot_from_sensor(header.frame, stamp);
    const auto odom_from_then = contents_.odometry_at(stamp, longest_gap_ns);
    const auto odom_from_now = contents_.odometry_at(observation_ns, longest_gap_ns);
    if (!then_from_sensor || !odom_from_then || !odom_from_now) return std::nullopt;
    return inverse(*odom_from_now) * *odom_from_then * *then_from_sensor;
  };
  if (!rule_.is_deskewed) {
    const auto sensor = robot_from_sensor(header.frame, header.stamp_ns);
    return sensor ? std::optional(RayMover(*sensor, *sensor, {0.0, 0.0})) : std::nullopt;
  }
  const auto first = sensor_at(span.first), last = sensor_at(span.second);
  return first && last ? std::optional(RayMover(*first, *last, span)) : std::nullopt;
}

bool ScanPlacer::can_place(const SensorScan& rays, const Header& header, std::int64_t observation_ns) const {
  return mover_of(header, observation_ns, time_span(rays)).has_value();
}

bool ScanPlacer::add(const SensorScan& rays, const Header& header, std::int64_t observation_ns,
                     std::size_t of, Scan& scan) const {
  const auto mover = mover_of(header, observation_ns, time_span(rays));
  if (!mover) return false;
  const auto is_wanted = [&](double z) {
    return rule_.heights.empty() || (z >= rule_.heights[0] && z <= rule_.heights[1]);
  };
  const auto place = [&](const Point& end, double time, Points& ends) {
    const Vector3 p = mover->moved(end, time);
    if (!is_wanted(p.z())) return false;
    ends.push_back(as_point({p.x(), p.y(), rule_.is_planar ? 0.0 : p.z()}));
    return true;
  };
  const bool several = contents_.scans.size() > 1;
  const bool keeps_times = !rule_.is_deskewed && (several || !rays.hit_times.empty());
  const double since_stamp = seconds(header.stamp_ns - observation_ns);
  for (std::size_t i = 0; i < rays.hits.size(); ++i) {
    const double time = rays.hit_times.empty() ? 0.0 : rays.hit_times[i];
    if (place(rays.hits[i], time, scan.hits) && keeps_times)
      scan.times.push_back(static_cast<float>(since_stamp + time));
  }
  for (std::size_t i = 0; i < rays.free_ends.size(); ++i)
    place(rays.free_ends[i], rays.free_times.empty() ? 0.0 : rays.free_times[i], scan.free_ends);
  // Of several sensors the rays begin halfway between them.
  const Vector3 share = (1.0 / static_cast<double>(of)) * mover->moved({}, 0.0);
  scan.origin =
      as_point(as_vector(scan.origin) + Vector3{share.x(), share.y(), rule_.is_planar ? 0.0 : share.z()});
  return true;
}

SensorScan read_rays(const RecordedMessage& message, const RangeLimits& limits) {
  return message.connection->type == "sensor_msgs/PointCloud2" ? rays_of(read_point_cloud(message), limits)
                                                               : rays_of(read_laser_scan(message), limits);
}

std::pair<double, double> time_span(const SensorScan& rays) {
  double first = 0.0, last = 0.0;
  for (const auto* times : {&rays.hit_times, &rays.free_times}) {
    for (const float time : *times) {
      first = std::min(first, double{time});
      last = std::max(last, double{time});
    }
  }
  return {first, last};
}

std::int64_t nanoseconds(double seconds) {
  return static_cast<std::int64_t>(std::llround(seconds * ns_per_s));
}

double seconds(std::int64_t ns) {
  return static_cast<double>(ns) / ns_per_s;
}

}  // namespace glocal::bags
