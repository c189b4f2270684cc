// glocal check: everything but running.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/experiment_options.hpp"
#include "app/standard_streams.hpp"
#include "evaluation/results/fault_collector.hpp"
#include "evaluation/running/experiment_loader.hpp"

namespace glocal::app {
namespace {

struct CheckOptions {
  std::vector<std::string> files;
  ExperimentOptions experiment;
};

void check(const std::string& file, const ExperimentOptions& options, Context& context) {
  std::vector<Variant> variants = options.read_variants(file, context);
  ExperimentLoader loader(context.catalog, [](const std::string& text) { spdlog::warn(text); });
  static_cast<void>(count_trials(variants, loader, context.catalog));
  Experiment& first = variants.front().experiment;
  LoadedExperiment& loaded = loader.load(first);
  const Localizer localizer = make_localizer(first, context.catalog, loaded);
  if (const auto why = why_never_declared(first, loaded, localizer)) spdlog::warn("{}: {}", file, *why);
  answer("{}: ok, {} map points, {} observations, {} trials{}\n", file, loaded.map->points().size(),
         loaded.drive.samples.size(), loaded.starts.size(),
         variants.size() > 1 ? fmt::format(" of each of {} variants", variants.size()) : "");
}

void check_all(const CheckOptions& options, Context& context) {
  FaultCollector faults;
  for (const std::string& file : options.files)
    faults.collect([&] { check(file, options.experiment, context); });
  faults.report();
}

}  // namespace

void add_check(CLI::App& app, Context& context) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* command =
      app.add_subcommand("check", "Read experiments, load their maps and observations, but run nothing.");
  command->add_option("FILE", options->files, "Experiment files (YAML)")->required();
  options->experiment.add_overrides_to(*command);
  command->callback([options, &context] { check_all(*options, context); });
}

}  // namespace glocal::app
