// glocal sweep: what is learned from the settings that an experiment was run with.
#include <fmt/format.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/results_at_hand.hpp"
#include "app/standard_streams.hpp"
#include "evaluation/comparison/named_runs.hpp"
#include "evaluation/sweeps/analysis.hpp"
#include "evaluation/sweeps/sweep_report.hpp"

namespace glocal::app {
namespace {

struct SweepOptions {
  std::string folder, baseline;
  std::vector<std::string> map;  ///< Two parameters, or none.
  std::size_t top = 20;
  bool json = false;
};

void analyse(const SweepOptions& options) {
  const std::vector<NamedRun> runs = read_sweep(options.folder);
  MapChoice map;
  if (!options.map.empty()) map = {options.map.at(0), options.map.at(1)};
  const SweepAnalysis analysis = analyse_sweep(runs, map, options.baseline);
  if (options.json) {
    answer(json_text(analysis));
  } else {
    answer(text_report(analysis, options.top));
  }
}

}  // namespace

void add_sweep(CLI::App& app, Context& /*context*/) {
  auto options = std::make_shared<SweepOptions>();
  CLI::App* command = app.add_subcommand(
      "sweep", "Show which settings of an experiment are best, which parameters matter, and what is chance.");
  command->add_option("DIR", options->folder, "Folder that holds the results of all variants")->required();
  command->add_option("--baseline", options->baseline,
                      "Setting to compare all others with (default: the first)");
  command->add_option("--map", options->map, "The two parameters of the map (default: of the largest effect)")
      ->expected(2)
      ->type_name("A B");
  CLI::Option* top = command->add_option("--top", options->top, "Settings to list")
                         ->check(CLI::Range(1, 1'000'000))
                         ->capture_default_str();
  command->add_flag("--json", options->json, "All numbers as JSON")->excludes(top);
  command->callback([options] { analyse(*options); });
}

}  // namespace glocal::app
