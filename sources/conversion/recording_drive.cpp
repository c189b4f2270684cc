#include "sources/conversion/recording_drive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "glocal/error.hpp"
#include "glocal/words.hpp"
#include "sources/bags/cdr_writer.hpp"
#include "sources/bags/message_reader.hpp"
#include "sources/bags/scan_placer.hpp"

namespace glocal::conversion {
namespace {

constexpr const char* odom_frame = "odom";
constexpr const char* base_frame = "base_link";

}  // namespace

RecordingDriveReader::RecordingDriveReader(const std::filesystem::path& path, const bags::DriveTopics& topics,
                                           bags::Damage damage, Warn warn, TellProgress progress)
    : file_(path.string()), warn_(std::move(warn)), recording_(path, damage) {
  recording_.tell_progress(std::move(progress));
  contents_ = bags::read_contents(recording_, topics, file_, warn_);
  std::set<std::string> with_scans;
  for (const bags::ScanTopic& scan : contents_.scans) {
    with_scans.insert(scan.topic);
    const auto& mount = contents_.mount(scan.frame);
    sensors_.push_back({scan.topic, scan.frame, scan.are_clouds,
                        mount && mount->is_still() ? mount->pose(0, bags::longest_gap_ns) : std::nullopt});
  }
  recording_.rewind(with_scans);
}

std::optional<DriveScan> RecordingDriveReader::next() {
  while (const auto message = recording_.next()) {
    if (!bags::is_readable(*message->connection) || !bags::has_scans(message->connection->type)) continue;
    try {
      if (auto scan = scan_of(*message)) return scan;
      ++without_pose_;
    } catch (const ConfigError&) {
      ++unreadable_;
    }
  }
  warn_of_lost();
  return std::nullopt;
}

std::optional<DriveScan> RecordingDriveReader::scan_of(const bags::RecordedMessage& message) {
  const auto sensor = std::ranges::find(sensors_, message.connection->topic, &DriveSensor::topic);
  DriveScan scan;
  scan.sensor = static_cast<std::size_t>(sensor - sensors_.begin());
  bags::Header header;
  if (sensor->has_clouds) {
    header = std::get<bags::PointCloud>(scan.rays = bags::read_point_cloud(message)).header;
  } else {
    header = std::get<bags::LaserScan>(scan.rays = bags::read_laser_scan(message)).header;
  }
  scan.stamp_ns = header.stamp_ns;
  const auto odometry = contents_.odometry_at(header.stamp_ns, bags::longest_gap_ns);
  const auto mount = contents_.robot_from_sensor(header.frame, header.stamp_ns, bags::longest_gap_ns);
  if (!odometry || !mount) return std::nullopt;
  scan.odom_from_robot = *odometry;
  scan.robot_from_sensor = *mount;
  scan.map_from_robot = contents_.reference_at(header.stamp_ns, bags::longest_gap_ns);
  return scan;
}

void RecordingDriveReader::warn_of_lost() {
  if (without_pose_ > 0)
    warn_(
        fmt::format("{}: {} scans are left out, as it is not known where the robot and its sensor were at "
                    "their time",
                    file_, without_pose_));
  if (unreadable_ > 0)
    warn_(fmt::format("{}: {} scans are left out, as they break their definition", file_, unreadable_));
  without_pose_ = unreadable_ = 0;
}

McapDriveWriter::McapDriveWriter(std::vector<DriveSensor> sensors, bags::McapWriter::Sink sink)
    : sensors_(std::move(sensors)), writer_(std::move(sink)) {}

void McapDriveWriter::write_fixed_poses(std::int64_t stamp_ns) {
  std::vector<bags::FrameTransform> fixed;
  for (const DriveSensor& sensor : sensors_) {
    if (sensor.robot_from_sensor)
      fixed.push_back({{stamp_ns, base_frame}, sensor.frame, *sensor.robot_from_sensor});
  }
  if (!fixed.empty()) writer_.write("/tf_static", "tf2_msgs/TFMessage", stamp_ns, bags::serialized(fixed));
}

void McapDriveWriter::write(const DriveScan& scan) {
  if (!std::exchange(has_begun_, true)) write_fixed_poses(scan.stamp_ns);
  const DriveSensor& sensor = sensors_[scan.sensor];
  std::vector<bags::FrameTransform> moving = {
      {{scan.stamp_ns, odom_frame}, base_frame, scan.odom_from_robot}};
  if (!sensor.robot_from_sensor)
    moving.push_back({{scan.stamp_ns, base_frame}, sensor.frame, scan.robot_from_sensor});
  writer_.write("/tf", "tf2_msgs/TFMessage", scan.stamp_ns, bags::serialized(moving));
  if (scan.map_from_robot)
    writer_.write("/reference", "geometry_msgs/PoseStamped", scan.stamp_ns,
                  bags::serialized(bags::StampedFramePose{{scan.stamp_ns, "map"}, *scan.map_from_robot, {}}));
  const std::string type = sensor.has_clouds ? "sensor_msgs/PointCloud2" : "sensor_msgs/LaserScan";
  writer_.write(sensor.topic, type, scan.stamp_ns,
                std::visit([](const auto& rays) { return bags::serialized(rays); }, scan.rays));
}

}  // namespace glocal::conversion
