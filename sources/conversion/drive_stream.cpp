#include "sources/conversion/drive_stream.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "glocal/error.hpp"

namespace glocal::conversion {

std::int64_t nanoseconds_of(double stamp) {
  return std::llround(stamp * 1e6) * 1000;
}

void check_stamp(double stamp, const std::string& file, int line) {
  constexpr double end = 2147483647.0;  // s; the largest that ROS 2's messages have.
  if (stamp >= 0.0 && stamp < end) return;
  throw ConfigError({{file, line, 0,
                      fmt::format("the time stamp {} is not of the years 1970 to 2037, which other formats "
                                  "have; correct it",
                                  stamp)}});
}

DriveCounts pass_on(DriveReader& reader, DriveWriter& writer, const std::string& file, const Warn& warn) {
  std::vector<std::int64_t> last(reader.sensors().size(), std::numeric_limits<std::int64_t>::min());
  DriveCounts counts;
  std::size_t backwards = 0;
  while (const auto scan = reader.next()) {
    if (scan->stamp_ns <= last[scan->sensor]) {
      ++backwards;
      continue;
    }
    last[scan->sensor] = scan->stamp_ns;
    writer.write(*scan);
    ++counts.scans;
    counts.references += scan->map_from_robot ? 1 : 0;
  }
  if (backwards > 0)
    warn(fmt::format("{}: {} scans are left out, as their stamps stand still or run backwards", file,
                     backwards));
  if (counts.scans == 0)
    throw ConfigError(file, "has no scan that can be written; glocal bag info shows what a recording has");
  writer.finish();
  return counts;
}

}  // namespace glocal::conversion
