#include "sources/carmen/carmen_log.hpp"

#include <string>

namespace glocal::carmen {
namespace {

void warn_of_stamps(const LogDrive& drive, const std::filesystem::path& file, const Warn& warn) {
  std::size_t bad = 0;
  for (std::size_t i = 1; i < drive.scans.size(); ++i) {
    if (drive.scans[i].stamp <= drive.scans[i - 1].stamp) ++bad;
  }
  if (bad == 0) return;
  warn(file.string() + ": " + std::to_string(bad) + " of " + std::to_string(drive.scans.size()) +
       " time stamps stand still or run backwards; scans are used in file order");
}

}  // namespace

CarmenLog::CarmenLog(const Params& params, const SourceSetup& setup)
    : params_(params), drive_(read_log_drive(params)) {
  setup.note_input(params.path.resolved);
  warn_of_stamps(drive_, params.path.resolved, setup.warn);
}

std::optional<Sample> CarmenLog::next() {
  if (next_ == drive_.frames.size()) return std::nullopt;
  const LogFrame& frame = drive_.frames[next_++];
  const CarmenScan& scan = drive_.scans[frame.scan];
  return Sample{
      {scan.stamp, robot_scan(scan, params_), scan.odom_from_robot}, scan.map_from_robot, frame.segment};
}

}  // namespace glocal::carmen
