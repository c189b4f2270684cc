// Recordings that are whole, with messages that nobody meant: read to the end, as an experiment reads them.
#include "fuzz/drawn_recording.hpp"
#include "fuzz/harness.hpp"
#include "pipeline/stage_contracts.hpp"
#include "sources/bags/bag_drive.hpp"
#include "sources/bags/bag_map.hpp"

extern "C" int fuzz_recording_contents(const std::uint8_t* data, std::size_t size) {
  using namespace glocal;
  fuzz::Draw draw(data, size);
  const Motion motion = draw.byte() % 4 == 0 ? Motion::free : Motion::planar;
  const auto file = fuzz::write("recording", fuzz::drawn_recording(draw));
  SourceSetup setup;
  setup.motion = motion;
  // What lies too far away, the loader of experiments refuses.
  const auto answer = [](const auto& read) {
    try {
      return fuzz::answer(read);
    } catch (const BrokenContract&) {
      return 0;
    }
  };
  answer([&] {
    bags::BagMap::Params map;
    map.path.resolved = file;
    check_map(bags::BagMap(map, setup).load(), Motion::planar);
  });
  return answer([&] {
    bags::BagDrive::Params params;
    params.path.resolved = file;
    params.scans = {draw.byte() % 2 == 0 ? "/scan" : "/points"};
    params.heights = {-1.0, 2.0};
    params.deskew = draw.byte() % 2 == 0 ? "odometry" : "none";
    bags::BagDrive drive(params, setup);
    while (const auto sample = drive.next()) check_sample(*sample, motion);
  });
}
