// glocal check: everything but running.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <map>
#include <memory>
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

/// Of each case the place of its first variant.
std::map<std::string, std::size_t> first_of_cases(const std::vector<Variant>& variants) {
  std::map<std::string, std::size_t> firsts;
  for (std::size_t i = 0; i < variants.size(); ++i) firsts.try_emplace(variants[i].case_name, i);
  return firsts;
}

std::string told_budget(double ms, const Experiment& experiment, const Catalog& catalog,
                        LoadedExperiment& loaded) {
  const std::optional<int> looks = looks_within(ms, experiment, catalog, loaded);
  if (!looks) return "; no search of its first trials is long enough to be timed";
  int unit = 1;  // A measurement is worth two digits.
  while (*looks / unit >= 100) unit *= 10;
  return fmt::format("; {} ms of searches a step are localizer.looks_per_step={} here", ms,
                     *looks / unit * unit);
}

void check(const std::string& file, const CheckOptions& options, Context& context) {
  std::vector<Variant> variants = options.experiment.read_variants(file, context);
  const std::map<std::string, std::size_t> firsts = first_of_cases(variants);
  const std::size_t shared = variants.size() / firsts.size();
  std::map<std::size_t, std::string> answers;  // One setting and one seed of each case speak for it.
  ExperimentLoader loader(context.catalog, warn);
  const auto tell = [&](std::size_t i, LoadedExperiment& loaded, const Localizer& localizer) {
    const Variant& variant = variants[i];
    std::string& said = answers[firsts.at(variant.case_name)];
    if (!said.empty()) return;
    std::string what = file;
    if (!variant.case_name.empty()) what += (file.empty() ? "" : ", ") + ("case " + variant.case_name);
    if (const auto why = why_never_declared(variant.experiment, loaded, localizer))
      spdlog::warn("{}: {}", what, *why);
    said = fmt::format("{}: ok, {} map points, {} observations, {} trials{}{}", what,
                       loaded.map->points().size(), loaded.drive.samples.size(), loaded.starts.size(),
                       shared > 1 ? fmt::format(" of each of {} variants", shared) : "",
                       options.budget_ms
                           ? told_budget(*options.budget_ms, variant.experiment, context.catalog, loaded)
                           : "");
  };
  static_cast<void>(count_trials(variants, loader, tell));
  for (const auto& [place, text] : answers) answer("{}\n", text);
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
