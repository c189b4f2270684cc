// glocal simulate: an experiment's simulated drive and map as files, and an experiment that reads them back.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>

#include "app/commands.hpp"
#include "app/experiment_options.hpp"
#include "evaluation/results/output_folder.hpp"
#include "evaluation/results/provenance.hpp"
#include "glocal/error.hpp"
#include "sources/carmen_log.hpp"
#include "sources/carmen_writer.hpp"
#include "sources/ros_map.hpp"
#include "sources/ros_map_writer.hpp"
#include "sources/simulation.hpp"

namespace glocal::app {
namespace {

struct SimulateOptions {
  ExperimentOptions experiment;
  std::string out;
  bool force = false;
};

DriveParams drive_of(const Experiment& experiment, const std::string& file) {
  const auto* params = dynamic_cast<const ParamsOf<DriveParams>*>(&*experiment.observations.params);
  if (params != nullptr) return params->value;
  throw ConfigError({{file, 0, 0,
                      fmt::format("observations: come from {}; only a simulation can be simulated",
                                  experiment.observations.name)}});
}

/// `name` is a file beside the experiment that names it.
FilePath beside(const std::string& name) {
  return {name, name};
}

StrategyChoice recorded_map() {
  auto params = std::make_unique<ParamsOf<RosMap::Params>>();
  params->value.path = beside("map.yaml");
  return {"ros_map", std::move(params)};
}

StrategyChoice recorded_drive(const LaserParams& laser) {
  auto params = std::make_unique<ParamsOf<LogParams>>();
  params->value = scan_limits(laser);
  params->value.path = beside("drive.log");
  return {"carmen_log", std::move(params)};
}

void simulate(const SimulateOptions& options, Context& context) {
  Experiment experiment = options.experiment.read(context);
  const Catalog& catalog = context.catalog;
  const DriveParams drive = drive_of(experiment, options.experiment.file);
  OutputFolder folder(options.out, options.force);
  std::set<std::filesystem::path> inputs{std::filesystem::absolute(options.experiment.file)};
  SourceSetup setup;
  setup.seed = experiment.seed;
  setup.warn = [](const std::string& text) { spdlog::warn(text); };
  setup.note_input = [&](const std::filesystem::path& file) {
    inputs.insert(std::filesystem::absolute(file));
  };

  const MapData map = catalog.map_sources.make(experiment.map, setup)->load();
  folder.append("map.pgm", pgm(trinary_image(map.grid)));
  folder.append("map.yaml", ros_map_yaml(map.grid, "map.pgm"));

  setup.note_input(drive.world.resolved);
  DriveSimulator simulator(drive, experiment.seed);
  std::size_t scans = 0;
  while (const auto scan = simulator.next()) {
    folder.append("drive.log", carmen_lines(*scan));
    ++scans;
  }
  experiment.map = recorded_map();
  experiment.observations = recorded_drive(drive.laser);
  folder.append("experiment.yaml", effective_yaml(experiment, catalog));
  FileHashes hashes;
  folder.append("provenance.json", provenance(catalog, experiment.threads, inputs, hashes).dump(2) + "\n");
  folder.commit();
  fmt::print("{} scans, a map of {} x {} cells and an experiment in {}\n", scans, map.grid.width,
             map.grid.height, folder.path().string());
}

}  // namespace

void add_simulate(CLI::App& app, Context& context) {
  auto options = std::make_shared<SimulateOptions>();
  CLI::App* command = app.add_subcommand(
      "simulate",
      "Write an experiment's simulated drive (CARMEN log) and map (ROS), and an experiment that uses them.");
  options->experiment.add_to(*command);
  command->add_option("--out", options->out, "Folder for the files")->required();
  command->add_flag("--force", options->force, "Replace earlier files in that folder");
  command->callback([options, &context] { simulate(*options, context); });
}

}  // namespace glocal::app
