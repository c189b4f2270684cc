// glocal check: everything but running.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <set>
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

/// The variants with the first setting and seed of each case.
std::vector<Variant*> first_of_cases(std::vector<Variant>& variants) {
  std::vector<Variant*> firsts;
  std::set<std::string> seen;
  for (Variant& variant : variants) {
    if (seen.insert(variant.case_name).second) firsts.push_back(&variant);
  }
  return firsts;
}

void check(const std::string& file, const ExperimentOptions& options, Context& context) {
  std::vector<Variant> variants = options.read_variants(file, context);
  ExperimentLoader loader(context.catalog, warn);
  static_cast<void>(count_trials(variants, loader));
  const std::vector<Variant*> firsts = first_of_cases(variants);
  for (Variant* first : firsts) {
    std::string what = file;
    if (!first->case_name.empty()) what += (file.empty() ? "" : ", ") + ("case " + first->case_name);
    LoadedExperiment& loaded = loader.load(first->experiment);
    const Localizer localizer = make_localizer(first->experiment, context.catalog, loaded);
    if (const auto why = why_never_declared(first->experiment, loaded, localizer))
      spdlog::warn("{}: {}", what, *why);
    const std::size_t shared = variants.size() / firsts.size();
    answer("{}: ok, {} map points, {} observations, {} trials{}\n", what, loaded.map->points().size(),
           loaded.drive.samples.size(), loaded.starts.size(),
           shared > 1 ? fmt::format(" of each of {} variants", shared) : "");
  }
}

void check_all(const CheckOptions& options, Context& context) {
  if (options.files.empty()) return check("", options.experiment, context);
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
  command->add_option("FILE", options->files,
                      "Experiment files (YAML); none needed with --method and --case");
  options->experiment.add_products_to(*command);
  options->experiment.add_overrides_to(*command);
  command->callback([options, &context] { check_all(*options, context); });
}

}  // namespace glocal::app
