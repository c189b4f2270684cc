#include "sources/clouds/cloud_drive.hpp"

#include <algorithm>
#include <utility>

#include "sources/clouds/cloud_file.hpp"
#include "sources/clouds/thinning.hpp"

namespace glocal::clouds {
namespace {

/// Points nearer to the sensor are dropped: the robot itself, m.
constexpr double min_range = 0.5;

}  // namespace

void describe(ParamVisitor& v, SensorMount& p) {
  constexpr double far = 100.0;
  v.field("x", p.x, {.doc = "Forward of the robot's origin.", .unit = "m", .min = -far, .max = far});
  v.field("y", p.y, {.doc = "Left of the robot's origin.", .unit = "m", .min = -far, .max = far});
  v.field("z", p.z, {.doc = "Above the robot's origin.", .unit = "m", .min = -far, .max = far});
  v.field("roll_deg", p.roll_deg,
          {.doc = "Turned about x, before all else.", .unit = "deg", .min = -180.0, .max = 180.0});
  v.field("pitch_deg", p.pitch_deg,
          {.doc = "Then turned about y; above 0 looks down.", .unit = "deg", .min = -180.0, .max = 180.0});
  v.field("yaw_deg", p.yaw_deg, {.doc = "Then turned about z.", .unit = "deg", .min = -180.0, .max = 180.0});
}

Pose3 robot_from_sensor(const SensorMount& mount) {
  const Quaternion roll = exponential({radians(mount.roll_deg), 0.0, 0.0});
  const Quaternion pitch = exponential({0.0, radians(mount.pitch_deg), 0.0});
  return {{mount.x, mount.y, mount.z}, composed(composed(turn_about_z(radians(mount.yaw_deg)), pitch), roll)};
}

void describe(ParamVisitor& v, CloudDrive::Params& p) {
  v.field(
      "folder", p.folder,
      {.doc = "Folder of the clouds: PCD, PLY or KITTI (*.bin), in the order of the numbers at the ends of "
              "their names.",
       .required = true,
       .is_folder = true});
  v.field("odometry", p.odometry,
          {.doc = "Poses by odometry (TUM or KITTI), one for each cloud; without, no cloud is joined with "
                  "another."});
  v.field("reference", p.reference,
          {.doc = "Reference poses in the map (TUM or KITTI); without, nothing is judged."});
  v.field("poses_of", p.poses_of,
          {.doc = "What the poses of both files are of.", .choices = {"robot", "sensor"}});
  v.field("sensor", p.sensor, {.doc = "Where the sensor is on the robot; x is forward and z is up."});
  describe_segments(v, p.segments);
  describe_keyframes(v, p.keyframes);
  v.field("max_range", p.max_range,
          {.doc = "Points farther from the sensor are dropped.",
           .unit = "m",
           .above = 0.0,
           .audience = Audience::tuner});
  v.field(
      "voxel_size", p.voxel_size,
      {.doc = "Side of the cubes whose points are replaced by their mean; 0 takes all points as they are.",
       .unit = "m",
       .min = 0.0,
       .max = 100.0,
       .audience = Audience::tuner});
  describe_cloud_unit(v, p.unit);
  v.field(
      "stamp_of", p.stamp_of,
      {.doc = "Which point of a cloud its stamp and pose belong to, where points have times: scans that were "
              "made in motion.",
       .choices = {"first_point", "last_point"},
       .audience = Audience::expert});
  require_rising(v, p.segments);
  v.require(p.max_range > min_range, "max_range", "must be above 0.5 m: nearer points are the robot's own");
}

CloudDrive::CloudDrive(const Params& params, const SourceSetup& setup)
    : params_(params), warn_(setup.warn), robot_from_sensor_(robot_from_sensor(params.sensor)) {
  const DriveFiles files{params.folder.resolved, params.odometry.resolved, params.reference.resolved};
  for (const auto& input : {files.folder, files.odometry, files.reference}) {
    if (!input.empty()) setup.note_input(input);
  }
  const Pose3 sensor_from_robot = params.poses_of == "sensor" ? inverse(robot_from_sensor_) : Pose3{};
  std::vector<DriveCloud> clouds = drive_clouds(files, warn_);
  for (DriveCloud& cloud : clouds) {
    for (auto* pose : {&cloud.odometry, &cloud.reference}) {
      if (*pose) *pose = **pose * sensor_from_robot;
    }
  }
  clouds_ = picked(clouds);
  for (const DriveCloud& cloud : clouds_) setup.note_input(cloud.file);
}

std::vector<DriveCloud> CloudDrive::picked(const std::vector<DriveCloud>& clouds) const {
  // Without odometry nothing is known of the way: each cloud counts the same.
  std::vector<double> lengths(clouds.size(), 0.0);
  for (std::size_t i = 1; i < clouds.size(); ++i) {
    const auto& last = clouds[i - 1].odometry;
    lengths[i] = lengths[i - 1] + (last ? distance(*last, *clouds[i].odometry) : 1.0);
  }
  std::vector<DriveCloud> used;
  const auto places = places_on(params_.segments, lengths, params_.folder.resolved.string(), "cloud");
  for (std::size_t segment = 0; segment < places.size(); ++segment) {
    const std::size_t first = used.size();
    for (const std::size_t i : places[segment]) {
      const bool is_used = used.size() == first || !clouds[i].odometry ||
                           is_keyframe(*used.back().odometry, *clouds[i].odometry, params_.keyframes);
      if (!is_used) continue;
      used.push_back(clouds[i]);
      used.back().segment = static_cast<int>(clouds[i].odometry ? segment : i);
    }
  }
  return used;
}

std::optional<Sample> CloudDrive::next() {
  if (next_ == clouds_.size()) return std::nullopt;
  const std::size_t number = next_++;
  const DriveCloud& source = clouds_[number];
  const Cloud cloud = read_cloud(source.file, {.unit = params_.unit, .is_scan = true});
  if (cloud.points.empty() && !std::exchange(has_warned_, true))
    warn_(source.file.string() + ": has no points; others like it are not told");
  if (number == 0 && !cloud.points.empty()) {
    for (const std::string& remark : cloud_remarks(cloud)) warn_(source.file.string() + ": " + remark);
  }
  return Sample{
      {source.stamp, scan_of(cloud), source.odometry.value_or(Pose3{})}, source.reference, source.segment};
}

Scan CloudDrive::scan_of(const Cloud& cloud) const {
  const double min_squared = min_range * min_range;
  const double max_squared = params_.max_range * params_.max_range;
  const bool has_times = !cloud.times.empty();
  const double stamp =
      has_times && params_.stamp_of == "last_point" ? *std::ranges::max_element(cloud.times) : 0.0;
  Points in_range;
  Scan scan;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Point p = cloud.points[i];
    const double squared =
        static_cast<double>(p.x) * p.x + static_cast<double>(p.y) * p.y + static_cast<double>(p.z) * p.z;
    if (squared < min_squared || squared > max_squared) continue;
    in_range.push_back(p);
    if (has_times) scan.times.push_back(static_cast<float>(cloud.times[i] - stamp));
  }
  if (params_.voxel_size > 0.0) thin_out(in_range, scan.times, params_.voxel_size);
  scan.hits = moved(in_range, robot_from_sensor_);
  scan.origin = as_point(robot_from_sensor_.translation());
  return scan;
}

}  // namespace glocal::clouds
