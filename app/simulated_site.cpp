#include "app/simulated_site.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "app/localize_plan.hpp"
#include "glocal/error.hpp"
#include "sources/simulation/simulation.hpp"
#include "sources/simulation/world_grid.hpp"
#include "sources/sites/office.hpp"
#include "sources/sites/office_site.hpp"

namespace glocal::app {
namespace {

constexpr int most_starts = 150;  // unless more are asked for

constexpr double metres_a_start = 10.0;

double length_of(const SiteOptions& options) {
  return options.length > 0.0 ? options.length : sites::usual_length(options.side);
}

int starts_of(const SiteOptions& options) {
  if (options.starts > 0) return options.starts;
  return std::clamp(static_cast<int>(length_of(options) / metres_a_start), 1, most_starts);
}

std::string experiment_of(const SiteOptions& options, std::uint64_t seed, const std::string& log,
                          const Catalog& catalog) {
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
      "trials: {{every_m: {}, max_steps: 41, min_steps: 41}}\n"
      "{}",
      options.site, options.side, options.side, seed, options.site, options.side, seed, seed, log,
      limits.min_range, limits.max_range, limits.free_range, length_of(options) / starts_of(options),
      localizer_yaml(default_method(false), {}, catalog));
}

/// CLI::Range takes what is no number.
CLI::Validator within(double low, double high) {
  const auto fault = [=](const std::string& text) {
    double value = 0.0;
    const bool is_within = CLI::detail::lexical_cast(text, value) && value >= low && value <= high;
    return is_within ? std::string() : fmt::format("{} is not a number from {} to {}", text, low, high);
  };
  return {fault, fmt::format("{} to {}", low, high)};
}

}  // namespace

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

SimulatedFiles simulated_site(const SiteOptions& options, std::uint64_t seed, const Catalog& catalog) {
  if (options.side == 0.0) throw ConfigError("--site " + options.site, "needs --side, its side in metres");
  simulation::World world = sites::office_site(options.side, length_of(options), seed);
  OccupancyGrid grid = simulation::plan_of(world, options.resolution, fmt::format("--site {}", options.site));
  SimulatedFiles files{*simulation::Simulation(sites::office_drive(), std::move(world), seed).recording(),
                       std::move(grid),
                       {},
                       1};
  files.experiment = experiment_of(options, seed, files.drive.file_name, catalog);
  return files;
}

}  // namespace glocal::app
