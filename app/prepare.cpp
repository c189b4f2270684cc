// glocal prepare: a benchmark case from a recording and a trajectory.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/cloud_folder_writer.hpp"
#include "app/commands.hpp"
#include "app/drive_options.hpp"
#include "app/interrupts.hpp"
#include "app/numbers.hpp"
#include "app/prepared_case.hpp"
#include "app/reading_bar.hpp"
#include "app/standard_streams.hpp"
#include "evaluation/results/output_folder.hpp"
#include "evaluation/results/pcd.hpp"
#include "evaluation/results/provenance.hpp"
#include "evaluation/running/experiment_loader.hpp"
#include "evaluation/running/reference_fit.hpp"
#include "glocal/error.hpp"
#include "sources/bags/scan_placer.hpp"
#include "sources/ros_map/ros_map_writer.hpp"

namespace glocal::app {
namespace {

using conversion::DriveTrack;
using conversion::ReferencePoses;
using conversion::TrackedScan;

namespace fs = std::filesystem;

struct PrepareOptions {
  DriveOptions log;
  std::string corrected, relations, out;
  std::string poses_of = "robot";
  double shift_s = 0.0;
  double max_gap_s = 0.5;
  double map_share = 0.0;     ///< 0: chosen.
  std::optional<int> blocks;  ///< None: chosen.
  bool force = false;
};

/// Says warnings, and keeps them for the README.
class Warnings {
 public:
  void add(const std::string& text) {
    spdlog::warn("{}", text);
    texts_.push_back(text);
  }
  [[nodiscard]] Warn call() {
    return [this](const std::string& text) { add(text); };
  }
  [[nodiscard]] const std::vector<std::string>& texts() const { return texts_; }

 private:
  std::vector<std::string> texts_;
};

DriveTrack read_track(const PrepareOptions& options, Warnings& warnings, const TellProgress& progress) {
  const auto reader = options.log.open(warnings.call(), progress);
  DriveTrack track = conversion::track_of(*reader);
  const auto tell = [&](std::size_t scans, const char* why) {
    if (scans > 0)
      warnings.add(fmt::format("{}: {} scans are left out, as {}", options.log.file, scans, why));
  };
  tell(track.backwards, "their stamps stand still or run backwards");
  tell(track.of_other_sensors, "they are of other sensors than the first one");
  return track;
}

ReferencePoses references_of(const PrepareOptions& options, const DriveTrack& drive) {
  ReferencePoses references;
  references.track = options.corrected.empty() ? conversion::own_references(drive.scans)
                                               : conversion::read_corrected(options.corrected, drive);
  references.are_of_sensor = options.poses_of == "sensor";
  references.shift_ns = bags::nanoseconds(options.shift_s);
  references.max_gap_ns = bags::nanoseconds(options.max_gap_s);
  if (references.track.size() == 0)
    throw ConfigError(options.log.file,
                      "has no reference poses; give a trajectory with --corrected, or a recording's topic "
                      "with --reference");
  return references;
}

std::vector<TrackedScan> with_references(const PrepareOptions& options, const DriveTrack& drive,
                                         const ReferencePoses& references) {
  std::vector<TrackedScan> scans = drive.scans;
  for (TrackedScan& scan : scans)
    scan.map_from_robot = references.map_from_robot(scan.stamp_ns, scan.robot_from_sensor);
  std::erase_if(scans, [](const TrackedScan& scan) { return !scan.map_from_robot; });
  if (scans.size() > 1) return scans;
  const auto [first, last] = references.track.span();
  const std::string scans_span =
      drive.scans.empty()
          ? "there are no scans"
          : fmt::format("scans are from {:.3f} to {:.3f} s", bags::seconds(drive.scans.front().stamp_ns),
                        bags::seconds(drive.scans.back().stamp_ns));
  throw ConfigError(
      options.log.file,
      fmt::format("no two scans have a reference pose: {}, reference poses from {:.3f} to {:.3f} s; if both "
                  "clocks differ, give --shift",
                  scans_span, bags::seconds(first), bags::seconds(last)));
}

CaseFacts facts_of(const PrepareOptions& options, const ReferencePoses& references, const DriveTrack& drive) {
  CaseFacts facts{.name = plain_name(options.out), .log = options.log.file, .corrected = options.corrected};
  facts.scans = with_references(options, drive, references);
  facts.has_clouds = drive.has_clouds;
  facts.all_scans = drive.scans.size();
  facts.robot_from_sensor = facts.scans.front().robot_from_sensor;
  facts.shift_s = options.shift_s;
  facts.odometry_shift = conversion::time_shift_of(drive, references);
  facts.jumps = conversion::reference_jumps(facts.scans);
  if (!options.relations.empty()) {
    facts.relations = conversion::relation_errors(conversion::read_relations(options.relations), facts.scans,
                                                  references.max_gap_ns);
    if (!facts.relations)
      throw ConfigError(options.relations,
                        "has no relation both of whose times have a reference pose; its times are those "
                        "of the log's scans");
  }
  facts.split = options.map_share > 0.0
                    ? conversion::split_drive(facts.scans, options.blocks.value_or(1), options.map_share)
                    : conversion::choose_split(facts.scans, options.blocks);
  return facts;
}

void write_drive(const PrepareOptions& options, const ReferencePoses& references, bool has_clouds,
                 OutputFolder& folder, const TellProgress& progress) {
  const Warn already_told = [](const std::string&) {};
  conversion::JoinedDrive drive(options.log.open(already_told, progress), references);
  if (has_clouds) {
    CloudFolderWriter writer(folder, options.log.file, "clouds");
    conversion::pass_on(drive, writer, options.log.file, already_told);
    return;
  }
  conversion::CarmenDriveWriter writer(drive.sensors(), options.log.file, [&](std::string_view lines) {
    if (is_interrupted()) throw RunError("interrupted; nothing is left of " + folder.path().string());
    folder.append("drive.log", lines);
  });
  conversion::pass_on(drive, writer, options.log.file, already_told);
}

/// Of what is said of files in the unfinished folder: they will be in the case's.
std::string with_final_paths(std::string text, const OutputFolder& folder) {
  const std::string hidden = folder.unfinished().string();
  for (std::size_t at = text.find(hidden); at != std::string::npos; at = text.find(hidden))
    text.replace(at, hidden.size(), folder.path().string());
  return text;
}

/// The experiment as `glocal run` will load it.
LoadedExperiment load_case(const OutputFolder& folder, const Catalog& catalog, Warnings& warnings) {
  try {
    const Experiment experiment = read_experiment(folder.unfinished() / "experiment.yaml", {}, catalog);
    return load_experiment(experiment, catalog,
                           [&](const std::string& text) { warnings.add(with_final_paths(text, folder)); });
  } catch (const ConfigError& error) {
    std::vector<Fault> faults = error.faults();
    for (Fault& fault : faults) fault.file = with_final_paths(fault.file, folder);
    throw ConfigError(std::move(faults));
  }
}

/// Those of the run's samples that are where the map was made.
Drive mapped_part(const LoadedExperiment& loaded) {
  Drive part = loaded.drive;
  const std::vector<Pose3>& path = loaded.map->path();
  std::erase_if(part.samples, [&](const Sample& sample) {
    return std::none_of(path.begin(), path.end(), [&](const Pose3& place) {
      return sample.map_from_robot &&
             distance(place, loaded.map->relative(*sample.map_from_robot)) <= conversion::near_map_m;
    });
  });
  return part;
}

/// How well the run's scans fit among themselves with the reference as it is, and with other shifts.
ScanShift scan_shift_of(const Drive& run, const ReferencePoses& references, const CaseFacts& facts) {
  constexpr int steps = 15;
  constexpr double step_s = 0.02, planar_epsilon = 0.05;  // m; finer than contact, to tell poses apart
  const double epsilon = facts.has_clouds ? facts.fit_within_m : planar_epsilon;
  const auto fit_with = [&](double shift_s) {
    const auto reference_at = [&](double stamp) {
      return references.map_from_robot(bags::nanoseconds(stamp - shift_s), facts.robot_from_sensor);
    };
    return fit_among_scans(run, reference_at, epsilon).value_or(0.0);
  };
  ScanShift best{.fit_unshifted = fit_with(0.0)};
  best.fit = best.fit_unshifted;
  const auto try_shift = [&](double shift_s) {
    const double fit = fit_with(shift_s);
    if (fit > best.fit) {
      best.shift_s = shift_s;
      best.fit = fit;
    }
    return fit;
  };
  for (int i = -steps; i <= steps; ++i) try_shift(i * step_s);
  if (facts.odometry_shift) best.fit_with_odometry = try_shift(facts.odometry_shift->shift_s);
  return best;
}

void write_map(const MapData& map, bool has_clouds, OutputFolder& folder) {
  if (has_clouds) return folder.append("map.pcd", pcd(map.points, map.origin));
  folder.append("map.pgm", ros_map::pgm(ros_map::trinary_image(map.grid)));
  folder.append("map.yaml", ros_map::ros_map_yaml(map.grid, "map.pgm", map.origin));
}

void prepare(const PrepareOptions& options, Context& context) {
  if (!options.corrected.empty() && !options.log.reference.empty())
    throw ConfigError(options.corrected,
                      "gives the reference poses, and --reference others: leave out one of them");
  OutputFolder::check(options.out, options.force);
  listen_to_interrupts();
  ReadingBar bar;
  Warnings warnings;
  const DriveTrack drive = read_track(options, warnings, bar.call());
  const ReferencePoses references = references_of(options, drive);
  CaseFacts facts = facts_of(options, references, drive);

  std::set<fs::path> inputs = options.log.inputs();
  for (const std::string& file : {options.corrected, options.relations}) {
    if (!file.empty()) inputs.insert(file);
  }
  OutputFolder folder(options.out, options.force, inputs);
  write_drive(options, references, facts.has_clouds, folder, bar.call());
  folder.append("experiment.yaml", case_experiment(facts, context.catalog));
  const LoadedExperiment loaded = load_case(folder, context.catalog, warnings);
  facts.fit_within_m = std::max(0.1, 2.0 * loaded.map->data().resolution);
  facts.fit = reference_fit(mapped_part(loaded), *loaded.map, facts.fit_within_m);
  facts.scan_shift = scan_shift_of(loaded.drive, references, facts);
  facts.map_points = loaded.map->points().size();
  facts.observations = loaded.drive.samples.size();
  facts.starts = loaded.starts.size();
  write_map(loaded.map->data(), facts.has_clouds, folder);

  for (const std::string& text : case_warnings(facts)) warnings.add(text);
  folder.append("README.md", case_readme(facts, warnings.texts()));
  FileHashes hashes;
  folder.append("provenance.json", provenance(context.catalog, 1, inputs, hashes).dump(2) + "\n");
  folder.commit();
  for (const auto& [name, value] : fact_lines(facts)) answer("{:<11} {}\n", name, value);
  answer("{:<11} {}\n", "experiment", (folder.path() / "experiment.yaml").string());
}

}  // namespace

void add_prepare(CLI::App& app, Context& context) {
  auto options = std::make_shared<PrepareOptions>();
  CLI::App* command = app.add_subcommand(
      "prepare", "Make a benchmark case of a recording and the trajectory that a SLAM tool has made of it.");
  options->log.add_to(*command, "LOG");
  command->add_option("--corrected", options->corrected,
                      "Reference poses: TUM, KITTI (one pose a scan), or CARMEN log with corrected poses "
                      "(default: those of the log)");
  command->add_option("--poses-of", options->poses_of, "Whose poses these are")
      ->check(CLI::IsMember({"robot", "sensor"}))
      ->capture_default_str();
  command->add_option("--shift", options->shift_s, "Added to the reference's stamps, s")
      ->check(within(-1e6, 1e6));
  command
      ->add_option("--max-gap", options->max_gap_s,
                   "Reference poses are interpolated between two that are at most this far apart, s")
      ->check(within(1e-3, 3600.0))
      ->capture_default_str();
  command->add_option("--relations", options->relations,
                      "Relative poses measured by hand (t1 t2 x y z roll pitch yaw), to check the reference");
  command
      ->add_option("--map-share", options->map_share,
                   "Share of the way that the map is made from (default: chosen from 0.3 to 0.7)")
      ->check(within(0.01, 0.99));
  command
      ->add_option("--blocks", options->blocks,
                   "Map and run take turns so many times (default: once, or five times for a drive that does "
                   "not come back)")
      ->check(CLI::Range(1, 100));
  command->add_option("-o,--out", options->out, "Folder for the case")->required();
  command->add_flag("--force", options->force, "Replace an earlier case");
  command->callback([options, &context] { prepare(*options, context); });
}

}  // namespace glocal::app
