// glocal check: everything but running.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/experiment_options.hpp"
#include "app/numbers.hpp"
#include "app/standard_streams.hpp"
#include "evaluation/results/fault_collector.hpp"
#include "evaluation/running/experiment_loader.hpp"
#include "evaluation/running/search_pace.hpp"

namespace glocal::app {
namespace {

struct CheckOptions {
  std::vector<std::string> files;
  ExperimentOptions experiment;
  std::optional<double> budget_ms;  ///< For the searches of a step.
};

std::string told_budget(double ms, const Experiment& experiment, const Catalog& catalog,
                        LoadedExperiment& loaded) {
  const std::optional<int> looks = looks_within(ms, experiment, catalog, loaded);
  if (!looks) return "; no search of its first trials is long enough to be timed";
  int unit = 1;  // A measurement is worth two digits.
  while (*looks / unit >= 100) unit *= 10;
  return fmt::format("; {} ms of searches a step are localizer.looks_per_step={} here", ms,
                     *looks / unit * unit);
}

/// Of the variants of a case.
std::string told_trials(const std::vector<std::size_t>& trials) {
  if (trials.size() == 1) return fmt::format("{} trials", trials.front());
  if (std::ranges::count(trials, trials.front()) == std::ssize(trials))
    return fmt::format("{} trials of each of {} variants", trials.front(), trials.size());
  const std::size_t all = std::accumulate(trials.begin(), trials.end(), std::size_t{0});
  return fmt::format("{} trials of {} variants", all, trials.size());
}

/// What is told of a case, in this order.
struct AboutCase {
  std::string loaded;
  std::vector<std::size_t> trials;  ///< Of each variant.
  std::string budget;
};

void check(const std::string& file, const CheckOptions& options, Context& context) {
  std::vector<Variant> variants = options.experiment.read_variants(file, context);
  std::map<std::string, AboutCase> answers;  // One setting and one seed of each case speak for it.
  ExperimentLoader loader(context.catalog, warn);
  const auto tell = [&](std::size_t i, LoadedExperiment& loaded, const Localizer& localizer) {
    const Variant& variant = variants[i];
    const auto [said, is_new] = answers.try_emplace(variant.case_name);
    if (!is_new) return;
    std::string what = file;
    if (!variant.case_name.empty()) what += (file.empty() ? "" : ", ") + ("case " + variant.case_name);
    if (const auto why = why_never_declared(variant.experiment, loaded, localizer))
      spdlog::warn("{}: {}", what, *why);
    said->second.loaded = fmt::format("{}: ok, {} map points, {} observations", what,
                                      loaded.map->points().size(), loaded.drive.samples.size());
    if (options.budget_ms)
      said->second.budget = told_budget(*options.budget_ms, variant.experiment, context.catalog, loaded);
  };
  const std::vector<std::size_t> trials = count_trials(variants, loader, tell);
  for (std::size_t i = 0; i < variants.size(); ++i)
    answers.at(variants[i].case_name).trials.push_back(trials[i]);
  for (const Variant& variant : variants) {  // In the order of the first variant of each.
    const auto said = answers.extract(variant.case_name);
    if (said.empty()) continue;
    answer("{}, {}{}\n", said.mapped().loaded, told_trials(said.mapped().trials), said.mapped().budget);
  }
}

void check_all(const CheckOptions& options, Context& context) {
  if (options.files.empty()) return check("", options, context);
  FaultCollector faults;
  for (const std::string& file : options.files) faults.collect([&] { check(file, options, context); });
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
  command
      ->add_option("--budget-ms", options->budget_ms,
                   "Tell how many looks the searches of a step take in so many ms on this machine")
      ->check(within(0.001, 1e6));
  command->callback([options, &context] { check_all(*options, context); });
}

}  // namespace glocal::app
