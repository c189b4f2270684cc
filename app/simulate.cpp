// glocal simulate: a simulated drive and map as files, and an experiment that reads them back.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "app/commands.hpp"
#include "app/experiment_options.hpp"
#include "app/localize_plan.hpp"
#include "app/numbers.hpp"
#include "app/standard_streams.hpp"
#include "evaluation/results/output_folder.hpp"
#include "evaluation/results/provenance.hpp"
#include "evaluation/running/experiment_loader.hpp"
#include "glocal/error.hpp"
#include "sources/ros_map/ros_map.hpp"
#include "sources/ros_map/ros_map_writer.hpp"
#include "sources/simulation/simulation.hpp"
#include "sources/simulation/world_grid.hpp"
#include "sources/sites/office.hpp"
#include "sources/sites/office_site.hpp"
#include "sources/text_lines.hpp"

namespace glocal::app {
namespace {

/// What `glocal simulate` writes.
struct SimulatedFiles {
  Recording drive;
  OccupancyGrid grid;
  std::string experiment;            ///< YAML, which names the files of both.
  int threads = 1;                   ///< Of the experiment.
  Vector3 origin = Vector3::Zero();  ///< That the grid is relative to, m.
};

struct SiteOptions {
  std::string site;
  double side = 0.0;         ///< m
  double resolution = 0.05;  ///< Of the map, m.
  double length = 0.0;       ///< Of the drive, m; 0: chosen.
  int starts = 0;            ///< Of the experiment; 0: chosen.

  /// Adds --site and what goes with it. This object must live as long as the command.
  void add_to(CLI::App& command);
};

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
  setup.warn = warn;
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
  if (map.grid.cells.empty())
    throw ConfigError(
        options.file,
        fmt::format("map: {} has no cells, of which a map of a planar laser is made", experiment.map.name));
  SimulatedFiles files{std::move(*drive), std::move(map.grid), {}, experiment.threads, map.origin};
  experiment.map = recorded_map();
  experiment.observations = std::move(files.drive.source);
  files.experiment = effective_yaml(experiment, catalog);
  return files;
}

constexpr int most_starts = 150;  // unless more are asked for

constexpr double metres_a_start = 10.0;

double length_of(const SiteOptions& options) {
  return options.length > 0.0 ? options.length : sites::usual_length(options.side);
}

int starts_of(const SiteOptions& options) {
  if (options.starts > 0) return options.starts;
  return std::clamp(static_cast<int>(length_of(options) / metres_a_start), 1, most_starts);
}

std::string experiment_of(const SiteOptions& options, std::uint64_t seed, const Recording& drive,
                          const Catalog& catalog) {
  constexpr std::size_t steps = 41;
  const carmen::LogParams limits = simulation::scan_limits(sites::office_drive().laser);
  return fmt::format(
      "# A simulated {} of {:g} m x {:g} m, seed {}. Written by glocal simulate.\n"
      "schema: 1\n"
      "name: {}_{:g}_{}\n"
      "seed: {}\n"
      "map:\n"
      "  ros_map: {{path: map.yaml}}\n"
      "observations:\n"
      "  carmen_log: {{path: {}, min_range: {}, max_range: {}, free_range: {}}}\n"
      "trials: {{every_m: {}, max_steps: {}, min_steps: {}}}\n"
      "{}",
      options.site, options.side, options.side, seed, options.site, options.side, seed, seed, drive.file_name,
      limits.min_range, limits.max_range, limits.free_range, length_of(options) / starts_of(options), steps,
      std::min(steps, drive.observations), localizer_yaml(default_method(false), {}, catalog));
}

/// Throws ConfigError where there is no side, and for a drive of too many observations.
SimulatedFiles simulated_site(const SiteOptions& options, std::uint64_t seed, const Catalog& catalog) {
  if (options.side == 0.0) throw ConfigError("--site " + options.site, "needs --side, its side in metres");
  simulation::World world = sites::office_site(options.side, length_of(options), seed);
  OccupancyGrid grid = simulation::plan_of(world, options.resolution, fmt::format("--site {}", options.site));
  SimulatedFiles files{*simulation::Simulation(sites::office_drive(), std::move(world), seed).recording(),
                       std::move(grid),
                       {},
                       1};
  files.experiment = experiment_of(options, seed, files.drive, catalog);
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
  OutputFolder folder(options.out, options.force, inputs);
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

void SiteOptions::add_to(CLI::App& command) {
  CLI::Option* kind =
      command.add_option("--site", site, "Make a site of this kind, in place of an experiment's world")
          ->check(CLI::IsMember({"office"}))
          ->excludes(command.get_option("--set"))
          ->excludes(command.get_option("--threads"));
  command.add_option("--side", side, "Side of the site (m)")->check(within(20.0, 2000.0))->needs(kind);
  command.add_option("--resolution", resolution, "Side of a cell of its map (m)")
      ->check(within(0.01, 1.0))
      ->capture_default_str()
      ->needs(kind);
  command.add_option("--length", length, "Way driven (m); five times the side, at most 3000 m, without it")
      ->check(within(10.0, 1e5))
      ->needs(kind);
  command.add_option("--starts", starts, "Number of starts; one every 10 m, at most 150, without it")
      ->check(CLI::Range(1, 10000))
      ->needs(kind);
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
