// glocal mapping: how far the local mapper of an experiment drifts along its drive.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/commands.hpp"
#include "app/experiment_options.hpp"
#include "app/numbers.hpp"
#include "app/standard_streams.hpp"
#include "evaluation/running/experiment_loader.hpp"
#include "evaluation/running/mapping_accuracy.hpp"
#include "evaluation/statistics/statistics.hpp"

namespace glocal::app {
namespace {

struct MappingOptions {
  ExperimentOptions experiment;
  std::vector<std::string> files;
  MappingWindows windows;
};

/// Only the drive and the local mapper are made: the map of the experiment has no part in this.
MappingAccuracy measure(const Experiment& experiment, const Catalog& catalog, const MappingWindows& windows) {
  const Drive drive = load_drive(experiment, catalog, {.warn = warn});
  const StageSetup stage_setup{
      .map = nullptr, .threads = experiment.threads, .motion = experiment.localizer.motion};
  const auto mapper = catalog.local_mappers.make(experiment.localizer.local_mapper, stage_setup);
  return measure_mapping(drive, *mapper, windows);
}

template <class Value>
std::vector<double> of_windows(const MappingAccuracy& accuracy, Value value) {
  std::vector<double> values;
  std::transform(accuracy.windows.begin(), accuracy.windows.end(), std::back_inserter(values), value);
  return values;
}

std::string row(const std::string& name, const MappingAccuracy& accuracy) {
  const auto& windows = accuracy.windows;
  if (windows.empty()) return fmt::format("{:<16}{:>8}  (the drive is too short)\n", name, 0);
  const auto translations =
      of_windows(accuracy, [](const MappingWindow& w) { return w.error.translation_m; });
  const auto rotations =
      of_windows(accuracy, [](const MappingWindow& w) { return degrees(w.error.rotation_rad); });
  const auto cells =
      of_windows(accuracy, [](const MappingWindow& w) { return static_cast<double>(w.occupied_cells); });
  const auto judged =
      std::count_if(windows.begin(), windows.end(), [](const auto& w) { return w.failed.has_value(); });
  const auto failed =
      std::count_if(windows.begin(), windows.end(), [](const auto& w) { return w.failed.value_or(false); });
  return fmt::format("{:<16}{:>8}{:>10.3f}{:>10.3f}{:>10.2f}{:>12}{:>8.0f}{:>10.3f}{:>10.3f}\n", name,
                     windows.size(), quantile(translations, 0.5), quantile(translations, 0.9),
                     quantile(rotations, 0.5), fmt::format("{}/{}", failed, judged), quantile(cells, 0.5),
                     quantile(accuracy.add_ms, 0.5), quantile(accuracy.add_ms, 0.95));
}

void mapping(const MappingOptions& options, Context& context) {
  // What goes by which name: an experiment, or a variant of what --method and --case say.
  std::vector<std::pair<std::string, Experiment>> experiments;
  for (const std::string& file : options.files) {
    Experiment experiment = options.experiment.read(file, context);
    experiments.emplace_back(experiment.name, std::move(experiment));
  }
  if (options.files.empty()) {
    for (Variant& variant : options.experiment.read_variants("", context))
      experiments.emplace_back(variant.name, std::move(variant.experiment));
  }
  if (options.windows.whole) {
    answer("Error of the local map's robot pose at the end of the drive.\n");
  } else {
    answer(
        "Error of the local map's robot pose after {} m, starts every {} m; failures ({} m or {} deg) after "
        "{} m.\n",
        options.windows.after_m, options.windows.every_m, options.windows.fail_translation,
        options.windows.fail_rotation_deg, options.windows.fail_after_m);
  }
  answer("{:<16}{:>8}{:>10}{:>10}{:>10}{:>12}{:>8}{:>10}{:>10}\n", "experiment", "windows", "median m",
         "p90 m", "med. deg", "failures", "cells", "median ms", "p95 ms");
  for (const auto& [name, experiment] : experiments)
    answer(row(name, measure(experiment, context.catalog, options.windows)));
}

}  // namespace

void add_mapping(CLI::App& app, Context& context) {
  auto options = std::make_shared<MappingOptions>();
  CLI::App* command =
      app.add_subcommand("mapping", "Measure how far an experiment's local mapper drifts along its drive.");
  command->add_option("FILE", options->files,
                      "Experiment files (YAML) whose observations have reference poses; none needed with "
                      "--method and --case");
  options->experiment.add_products_to(*command);
  CLI::Option* whole =
      command->add_flag("--whole", options->windows.whole,
                        "One start only, and the error at the end of the drive or where it is interrupted");
  command->add_option("--every", options->windows.every_m, "Way from one start to the next, m")
      ->excludes(whole)
      ->check(above_zero())
      ->capture_default_str();
  command->add_option("--after", options->windows.after_m, "Way after which the error is taken, m")
      ->excludes(whole)
      ->check(above_zero())
      ->capture_default_str();
  command
      ->add_option("--fail-after", options->windows.fail_after_m, "Way after which failures are counted, m")
      ->excludes(whole)
      ->check(above_zero())
      ->capture_default_str();
  options->experiment.add_overrides_to(*command);
  command->callback([options, &context] { mapping(*options, context); });
}

}  // namespace glocal::app
