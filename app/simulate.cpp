// glocal simulate: a simulated drive and map as files, and an experiment that reads them back.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "app/commands.hpp"
#include "app/experiment_options.hpp"
#include "app/simulated_site.hpp"
#include "app/standard_streams.hpp"
#include "evaluation/results/output_folder.hpp"
#include "evaluation/results/provenance.hpp"
#include "evaluation/running/experiment_loader.hpp"
#include "glocal/error.hpp"
#include "sources/ros_map/ros_map.hpp"
#include "sources/ros_map/ros_map_writer.hpp"
#include "sources/text_lines.hpp"

namespace glocal::app {
namespace {

struct SimulateOptions {
  ExperimentOptions experiment;
  SiteOptions site;
  std::string out;
  bool force = false;
};

/// As a file beside the experiment that names it.
StrategyChoice recorded_map() {
  auto params = std::make_unique<ParamsOf<ros_map::RosMap::Params>>();
  params->value.path = {"map.yaml", "map.yaml"};
  return {"ros_map", std::move(params)};
}

/// What an experiment simulates, and what was read for it.
SimulatedFiles simulated_experiment(const ExperimentOptions& options, Context& context,
                                    std::set<std::filesystem::path>& inputs) {
  Experiment experiment = options.read(context);
  const Catalog& catalog = context.catalog;
  inputs.insert(std::filesystem::absolute(options.file));
  SourceSetup setup;
  setup.seed = seed_of(RandomPart::observation_source, experiment);
  setup.motion = experiment.localizer.motion;
  setup.warn = [](const std::string& text) { spdlog::warn(text); };
  setup.note_input = [&](const std::filesystem::path& file) {
    inputs.insert(std::filesystem::absolute(file));
  };
  auto drive = catalog.observation_sources.make(experiment.observations, setup)->recording();
  if (!drive) {
    throw ConfigError(options.file,
                      fmt::format("observations: come from {}; only a simulation of a planar laser can be "
                                  "written to files",
                                  experiment.observations.name));
  }
  MapData map = load_map(experiment, catalog, setup);
  SimulatedFiles files{std::move(*drive), std::move(map.grid), {}, experiment.threads, map.origin};
  experiment.map = recorded_map();
  experiment.observations = std::move(files.drive.source);
  files.experiment = effective_yaml(experiment, catalog);
  return files;
}

std::uint64_t seed_of_site(const SimulateOptions& options) {
  const std::string text = options.experiment.seed.value_or("1");
  const auto seed = whole_number_in(text);
  if (!seed) throw ConfigError("--seed " + text, "must be a whole number from 0 to 2^64 - 1");
  return *seed;
}

void simulate(const SimulateOptions& options, Context& context) {
  const bool is_site = !options.site.site.empty();
  if (is_site == !options.experiment.file.empty())
    throw ConfigError("simulate", "takes an experiment file, or --site office in its place");
  OutputFolder::check(options.out, options.force);
  std::set<std::filesystem::path> inputs;
  const SimulatedFiles files = is_site ? simulated_site(options.site, seed_of_site(options), context.catalog)
                                       : simulated_experiment(options.experiment, context, inputs);
  OutputFolder folder(options.out, options.force);
  folder.append(files.drive.file_name, files.drive.content);
  ros_map::write_trinary_pgm(files.grid, [&](std::string_view piece) { folder.append("map.pgm", piece); });
  folder.append("map.yaml", ros_map::ros_map_yaml(files.grid, "map.pgm", files.origin));
  folder.append("experiment.yaml", files.experiment);
  FileHashes hashes;
  folder.append("provenance.json", provenance(context.catalog, files.threads, inputs, hashes).dump(2) + "\n");
  folder.commit();
  answer("{} scans, a map of {} x {} cells and an experiment in {}\n", files.drive.observations,
         files.grid.width, files.grid.height, folder.path().string());
}

}  // namespace

void add_simulate(CLI::App& app, Context& context) {
  auto options = std::make_shared<SimulateOptions>();
  CLI::App* command = app.add_subcommand(
      "simulate",
      "Write a simulated drive (CARMEN log) and map (ROS), and an experiment that uses them: those of an "
      "experiment, or a site of any size.");
  command->add_option("FILE", options->experiment.file, "Experiment file (YAML)");
  options->experiment.add_overrides_to(*command);
  options->site.add_to(*command);
  command->add_option("-o,--out", options->out, "Folder for the files")->required();
  command->add_flag("--force", options->force, "Replace earlier files in that folder");
  command->callback([options, &context] { simulate(*options, context); });
}

}  // namespace glocal::app
