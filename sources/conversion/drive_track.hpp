// Where a robot was at each scan of a drive, by odometry and by reference poses of another origin.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "sources/bags/pose_track.hpp"
#include "sources/conversion/drive_stream.hpp"

namespace glocal::conversion {

struct DriveTrack {
  std::vector<TrackedScan> scans;  ///< Stamps rise.
  std::size_t backwards = 0;       ///< Scans left out, as their stamps stand still or run backwards.
  std::size_t of_other_sensors = 0;
  bool has_clouds = false;
};

/// Reads a drive to its end: the scans of its first sensor.
[[nodiscard]] DriveTrack track_of(DriveReader& reader);

/// Reference poses of scans, from a trajectory.
struct ReferencePoses {
  bags::PoseTrack track;  ///< Of the robot or of its sensor.
  bool are_of_sensor = false;
  std::int64_t shift_ns = 0;  ///< Added to the track's stamps.
  std::int64_t max_gap_ns = 500'000'000;

  /// The robot on the map at a time; `robot_from_sensor` is that of the scan. None where it is not known.
  [[nodiscard]] std::optional<Pose3> map_from_robot(std::int64_t stamp_ns,
                                                    const Pose3& robot_from_sensor) const;
};

/// The trajectory of a drive that a SLAM tool has made, as the file's content tells: TUM; KITTI with a pose
/// for each scan, whose stamps they then have; or a CARMEN log, whose reference poses (TRUEPOS) are taken,
/// or the robot's poses if it has none. Throws ConfigError where the readers of these do, for fewer than two
/// poses, and for KITTI poses of another number than the scans.
[[nodiscard]] bags::PoseTrack read_corrected(const std::filesystem::path& file, const DriveTrack& drive);

/// The reference poses that scans have themselves.
[[nodiscard]] bags::PoseTrack own_references(const std::vector<TrackedScan>& scans);

/// A drive's scans of the first sensor that have a reference pose, which is given to them.
class JoinedDrive final : public DriveReader {
 public:
  JoinedDrive(std::unique_ptr<DriveReader> reader, ReferencePoses references);

  [[nodiscard]] std::optional<DriveScan> next() override;

 private:
  std::unique_ptr<DriveReader> reader_;
  ReferencePoses references_;
};

}  // namespace glocal::conversion
