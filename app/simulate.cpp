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
#include "evaluation/running/experiment_loader.hpp"
#include "glocal/error.hpp"
#include "sources/ros_map.hpp"
#include "sources/ros_map_writer.hpp"

namespace glocal::app {
namespace {

struct SimulateOptions {
  ExperimentOptions experiment;
  std::string out;
  bool force = false;
};

/// As a file beside the experiment that names it.
StrategyChoice recorded_map() {
  auto params = std::make_unique<ParamsOf<RosMap::Params>>();
  params->value.path = {"map.yaml", "map.yaml"};
  return {"ros_map", std::move(params)};
}

void simulate(const SimulateOptions& options, Context& context) {
  Experiment experiment = options.experiment.read(context);
  OutputFolder::check(options.out, options.force);
  const Catalog& catalog = context.catalog;
  std::set<std::filesystem::path> inputs{std::filesystem::absolute(options.experiment.file)};
  SourceSetup setup;
  setup.seed = seed_of(RandomPart::observation_source, experiment);
  setup.motion = experiment.localizer.motion;
  setup.warn = [](const std::string& text) { spdlog::warn(text); };
  setup.note_input = [&](const std::filesystem::path& file) {
    inputs.insert(std::filesystem::absolute(file));
  };

  const auto drive = catalog.observation_sources.make(experiment.observations, setup)->recording();
  if (!drive) {
    throw ConfigError({{options.experiment.file, 0, 0,
                        fmt::format("observations: come from {}; only a simulation of a planar laser can be "
                                    "written to files",
                                    experiment.observations.name)}});
  }
  OutputFolder folder(options.out, options.force);
  folder.append(drive->file_name, drive->content);
  const MapData map = load_map(experiment, catalog, setup);
  folder.append("map.pgm", pgm(trinary_image(map.grid)));
  folder.append("map.yaml", ros_map_yaml(map.grid, "map.pgm"));

  experiment.map = recorded_map();
  experiment.observations = drive->source;
  folder.append("experiment.yaml", effective_yaml(experiment, catalog));
  FileHashes hashes;
  folder.append("provenance.json", provenance(catalog, experiment.threads, inputs, hashes).dump(2) + "\n");
  folder.commit();
  fmt::print("{} scans, a map of {} x {} cells and an experiment in {}\n", drive->observations,
             map.grid.width, map.grid.height, folder.path().string());
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
