#include "sources/conversion/drive_track.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "glocal/error.hpp"
#include "sources/carmen/carmen_parser.hpp"
#include "sources/clouds/trajectory_file.hpp"
#include "sources/compressed_file.hpp"
#include "sources/text_lines.hpp"

namespace glocal::conversion {
namespace {

/// Whether the first line that says something begins with a word, as messages of CARMEN do.
bool is_carmen_text(const std::string& content) {
  TextLines lines(content);
  while (lines.next_with_fields()) {
    if (!lines.fields().front().starts_with('#')) return !number_in(lines.fields().front());
  }
  return false;
}

bags::PoseTrack track_of_log(const std::filesystem::path& file) {
  const std::vector<carmen::CarmenScan> scans = carmen::read_carmen_log(file);
  const bool has_references =
      std::any_of(scans.begin(), scans.end(), [](const carmen::CarmenScan& s) { return s.map_from_robot; });
  bags::PoseTrack track;
  for (const carmen::CarmenScan& scan : scans) {
    check_stamp(scan.stamp, file.string(), scan.line);
    if (!has_references) track.add(nanoseconds_of(scan.stamp), scan.odom_from_robot);
    if (scan.map_from_robot) track.add(nanoseconds_of(scan.stamp), *scan.map_from_robot);
  }
  return track;
}

bags::PoseTrack track_of_trajectory(const std::string& content, const std::filesystem::path& file,
                                    const DriveTrack& drive) {
  const clouds::Trajectory trajectory = clouds::parse_trajectory(content, file.string());
  if (!trajectory.has_stamps && trajectory.poses.size() != drive.scans.size())
    throw ConfigError(file, fmt::format("has {} poses without stamps, and there are {} scans; write the "
                                        "trajectory with stamps, as TUM's format has them",
                                        trajectory.poses.size(), drive.scans.size()));
  bags::PoseTrack track;
  for (std::size_t i = 0; i < trajectory.poses.size(); ++i) {
    const clouds::StampedPose& pose = trajectory.poses[i];
    check_stamp(pose.stamp, file.string());
    track.add(trajectory.has_stamps ? nanoseconds_of(pose.stamp) : drive.scans[i].stamp_ns, pose.pose);
  }
  return track;
}

}  // namespace

DriveTrack track_of(DriveReader& reader) {
  DriveTrack track;
  track.has_clouds = reader.sensors().front().has_clouds;
  while (const auto scan = reader.next()) {
    if (scan->sensor != 0) {
      ++track.of_other_sensors;
    } else if (!track.scans.empty() && scan->stamp_ns <= track.scans.back().stamp_ns) {
      ++track.backwards;
    } else {
      track.scans.push_back(*scan);  // without its rays
    }
  }
  return track;
}

std::optional<Pose3> ReferencePoses::map_from_robot(std::int64_t stamp_ns,
                                                    const Pose3& robot_from_sensor) const {
  // Text files round stamps, and poses far apart may each be that of a scan.
  constexpr std::int64_t rounding_ns = 1'000'000;
  auto pose = track.nearest(stamp_ns - shift_ns, rounding_ns);
  if (!pose) pose = track.at(stamp_ns - shift_ns, max_gap_ns);
  return pose && are_of_sensor ? *pose * inverse(robot_from_sensor) : pose;
}

bags::PoseTrack read_corrected(const std::filesystem::path& file, const DriveTrack& drive) {
  const std::string content = read_decompressed(file);
  bags::PoseTrack track =
      is_carmen_text(content) ? track_of_log(file) : track_of_trajectory(content, file, drive);
  track.settle();
  if (track.size() < 2) throw ConfigError(file, "has a single pose, and a trajectory has several");
  return track;
}

bags::PoseTrack own_references(const std::vector<TrackedScan>& scans) {
  bags::PoseTrack track;
  for (const TrackedScan& scan : scans) {
    if (scan.map_from_robot) track.add(scan.stamp_ns, *scan.map_from_robot);
  }
  track.settle();
  return track;
}

JoinedDrive::JoinedDrive(std::unique_ptr<DriveReader> reader, ReferencePoses references)
    : reader_(std::move(reader)), references_(std::move(references)) {
  sensors_ = {reader_->sensors().front()};
}

std::optional<DriveScan> JoinedDrive::next() {
  while (auto scan = reader_->next()) {
    if (scan->sensor != 0) continue;
    scan->map_from_robot = references_.map_from_robot(scan->stamp_ns, scan->robot_from_sensor);
    if (scan->map_from_robot) return scan;
  }
  return std::nullopt;
}

}  // namespace glocal::conversion
