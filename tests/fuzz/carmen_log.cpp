// CARMEN logs, from the file to the scans that are matched.
#include "fuzz/harness.hpp"
#include "sources/carmen/log_drive.hpp"

extern "C" int fuzz_carmen_log(const std::uint8_t* data, std::size_t size) {
  using namespace glocal;
  carmen::LogParams params;
  params.path.resolved = fuzz::write("drive.log", fuzz::text_of(data, size));
  params.segments = {{0.0, 0.5}, {0.5, 1.0}};
  return fuzz::answer([&] {
    const carmen::LogDrive drive = carmen::read_log_drive(params);
    for (const carmen::LogFrame& frame : drive.frames)
      static_cast<void>(carmen::robot_scan(drive.scans[frame.scan], params));
  });
}
