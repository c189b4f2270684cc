#include "app/plain_suite.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "app/cloud_folder_writer.hpp"
#include "app/interrupts.hpp"
#include "evaluation/results/output_folder.hpp"
#include "evaluation/results/pcd.hpp"
#include "evaluation/results/provenance.hpp"
#include "evaluation/running/trials.hpp"
#include "glocal/error.hpp"
#include "sources/conversion/recording_drive.hpp"
#include "sources/ros_map/ros_map_writer.hpp"

namespace glocal::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* sensor_frame = "base_link";

/// Stamps of the scans, ns. Those of the drive, or where these do not rise, or cannot be written, one a
/// second.
std::vector<std::int64_t> stamps_of(const Drive& drive) {
  constexpr double latest = 2147483647.0;  // s
  std::vector<std::int64_t> stamps;
  bool is_good = true;
  for (const Sample& sample : drive.samples) {
    const double stamp = sample.observation.stamp;
    is_good = is_good && stamp >= 0.0 && stamp < latest;
    stamps.push_back(is_good ? conversion::nanoseconds_of(stamp) : 0);
    is_good = is_good && (stamps.size() < 2 || stamps[stamps.size() - 2] < stamps.back());
  }
  constexpr std::int64_t second = 1'000'000'000;
  for (std::size_t i = 0; !is_good && i < stamps.size(); ++i)
    stamps[i] = static_cast<std::int64_t>(i) * second;
  return stamps;
}

void write_plain_map(OutputFolder& folder, const fs::path& below, const GlobalMap& map) {
  folder.append(below / "map.pcd", pcd(map.points(), map.origin()));
  if (map.grid().cells.empty()) return;
  ros_map::write_trinary_pgm(map.grid(),
                             [&](std::string_view piece) { folder.append(below / "map.pgm", piece); });
  folder.append(below / "map.yaml", ros_map::ros_map_yaml(map.grid(), "map.pgm", map.origin()));
}

/// Both forms of the drive. Points are in the robot's frame.
void write_plain_drive(OutputFolder& folder, const fs::path& below, const Drive& drive) {
  conversion::McapDriveWriter recording(
      {{.topic = "/points", .frame = sensor_frame, .has_clouds = true, .robot_from_sensor = Pose3{}}},
      [&](std::string_view bytes) { folder.append(below / "drive.mcap", bytes); });
  CloudFolderWriter clouds(folder, below.string(), below / "scans");
  const std::vector<std::int64_t> stamps = stamps_of(drive);
  for (std::size_t i = 0; i < drive.samples.size(); ++i) {
    const Observation& observation = drive.samples[i].observation;
    conversion::DriveScan scan;
    scan.stamp_ns = stamps[i];
    scan.odom_from_robot = observation.odom_from_robot;
    scan.rays = bags::PointCloud{{scan.stamp_ns, sensor_frame}, observation.scan.hits, {}};
    recording.write(scan);
    clouds.write(scan);
  }
  recording.finish();
}

}  // namespace

std::size_t write_plain_suite(const Suite& suite, std::vector<Variant>& variants, ExperimentLoader& loader,
                              const fs::path& out, bool force) {
  OutputFolder folder(out, force);
  std::string starts = "case,seed,folder,start,scan,steps\n";
  std::size_t n = 0;
  for_each_loaded(variants, loader, [&](std::size_t i, LoadedExperiment& loaded) {
    if (is_interrupted()) throw RunError("interrupted; nothing is left of " + out.string());
    folder.spare(loaded.inputs);
    const Variant& variant = variants[i];
    const std::uint64_t seed = variant.experiment.seed;
    const std::string below =
        suite.seeds.size() == 1 ? variant.case_name : fmt::format("{}_seed-{}", variant.case_name, seed);
    write_plain_map(folder, below, *loaded.map);
    write_plain_drive(folder, below, loaded.drive);
    for (std::size_t start = 0; start < loaded.starts.size(); ++start, ++n)
      starts +=
          fmt::format("{},{},{},{},{},{}\n", variant.case_name, seed, below, start, loaded.starts[start],
                      steps_left(loaded.drive, variant.experiment.trials, loaded.starts[start]));
  });
  folder.append("starts.csv", starts);
  folder.append("provenance.json", provenance(loader.catalog(), 1, {}, loader.hashes()).dump(2) + "\n");
  folder.commit();
  return n;
}

}  // namespace glocal::app
