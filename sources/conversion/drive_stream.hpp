// Drives on their way from one format to another one, scan by scan.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "glocal/catalog.hpp"
#include "glocal/pose3.hpp"
#include "sources/bags/messages.hpp"

namespace glocal::conversion {

/// A laser or lidar.
struct DriveSensor {
  std::string topic;
  std::string frame;
  bool has_clouds = false;
  std::optional<Pose3> robot_from_sensor;  ///< None if it moves on the robot.
};

/// A scan without its rays: when it was measured, and where all was then.
struct TrackedScan {
  std::int64_t stamp_ns = 0;  ///< Since 1970, from 0 on; less than 2^31 s.
  Pose3 odom_from_robot;
  Pose3 robot_from_sensor;
  std::optional<Pose3> map_from_robot;  ///< The reference.
};

struct DriveScan : TrackedScan {
  std::size_t sensor = 0;                                ///< Index into DriveReader::sensors().
  std::variant<bags::LaserScan, bags::PointCloud> rays;  ///< With stamp and frame.
};

/// A stamp of a text file, s, which has it in microseconds.
[[nodiscard]] std::int64_t nanoseconds_of(double stamp);

/// Throws ConfigError for a stamp (s) that is before 1970 or after 2037; line 0 is none.
void check_stamp(double stamp, const std::string& file, int line = 0);

/// Where a drive comes from.
class DriveReader {
 public:
  DriveReader() = default;
  virtual ~DriveReader() = default;
  DriveReader(const DriveReader&) = delete;
  DriveReader& operator=(const DriveReader&) = delete;

  [[nodiscard]] const std::vector<DriveSensor>& sensors() const { return sensors_; }
  /// The next scan; none at the end. Throws ConfigError for what cannot be read.
  [[nodiscard]] virtual std::optional<DriveScan> next() = 0;

 protected:
  std::vector<DriveSensor> sensors_;
};

/// Where it goes.
class DriveWriter {
 public:
  DriveWriter() = default;
  virtual ~DriveWriter() = default;
  DriveWriter(const DriveWriter&) = delete;
  DriveWriter& operator=(const DriveWriter&) = delete;

  /// Throws ConfigError for what the format cannot have.
  virtual void write(const DriveScan& scan) = 0;
  virtual void finish() = 0;
};

/// What was passed on.
struct DriveCounts {
  std::size_t scans = 0, references = 0;
};

/// Passes all scans on. Those of a sensor whose stamps stand still or run backwards are left out, with a
/// warning. Throws ConfigError for a drive that has no other ones, and what reader and writer throw.
DriveCounts pass_on(DriveReader& reader, DriveWriter& writer, const std::string& file, const Warn& warn);

}  // namespace glocal::conversion
