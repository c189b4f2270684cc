// CARMEN logs as drives that are passed on, and the other way.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sources/carmen/carmen_parser.hpp"
#include "sources/conversion/drive_stream.hpp"

namespace glocal::conversion {

/// What a Sick LMS can measure at most, m. Logs without ranges of their own (FLASER, RLASER) are its: what it
/// reads beyond says that nothing was met.
inline constexpr double sick_range = 80.0;

/// The scan as ROS has it: readings that met nothing (carmen::LogParams) are infinite. `frame`: the laser's.
[[nodiscard]] bags::LaserScan laser_scan(const carmen::CarmenScan& scan, double max_range,
                                         const std::string& frame);

/// The scan as a line of ROBOTLASER1, seen from above: a laser mounted upside down is turned over, readings
/// that met nothing are max_range, and those that say nothing are 0. A scan without readings has one that
/// says nothing, and one without a largest range that of a Sick LMS. Throws ConfigError, naming `file`, for
/// clouds, a laser that is not level (by more than 1 deg), and scans of more than a turn.
[[nodiscard]] carmen::CarmenScan carmen_scan(const DriveScan& scan, const DriveSensor& sensor,
                                             const std::string& file);

/// A log's scans: those of the front laser on /scan, those of the rear one on /scan_rear. The log is held in
/// memory.
class CarmenDriveReader final : public DriveReader {
 public:
  /// `max_range`: m, for lines that do not say it. Throws ConfigError where carmen::read_carmen_log() does,
  /// and for stamps that are before 1970 or after 2037.
  explicit CarmenDriveReader(const std::filesystem::path& file, double max_range = sick_range);

  [[nodiscard]] std::optional<DriveScan> next() override;

 private:
  double max_range_;
  std::vector<carmen::CarmenScan> scans_;
  std::size_t next_ = 0;
};

/// Writes a CARMEN log, in large pieces.
class CarmenDriveWriter final : public DriveWriter {
 public:
  /// `file`: where the drive comes from, for what is said of it.
  CarmenDriveWriter(std::vector<DriveSensor> sensors, std::string file,
                    std::function<void(std::string_view)> sink)
      : sensors_(std::move(sensors)), file_(std::move(file)), sink_(std::move(sink)) {}

  void write(const DriveScan& scan) override;
  void finish() override;

 private:
  std::vector<DriveSensor> sensors_;
  std::string file_;
  std::function<void(std::string_view)> sink_;
  std::string lines_;
};

}  // namespace glocal::conversion
