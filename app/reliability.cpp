// glocal reliability: whether the confidences and covariances of runs mean what they say.
#include "evaluation/statistics/reliability.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/standard_streams.hpp"
#include "evaluation/comparison/named_runs.hpp"
#include "evaluation/results/number_text.hpp"
#include "evaluation/results/results_folder.hpp"
#include "glocal/error.hpp"

namespace glocal::app {
namespace {

using Json = nlohmann::ordered_json;

struct ReliabilityOptions {
  std::vector<std::string> folders;
};

/// What has been found out in all folders.
struct Findings {
  Reliability declared;
  Reliability believed;  ///< Declared or not; one step of each trial, so that they are independent.
  std::size_t trials = 0, right = 0, wrong = 0;
  std::size_t squared_errors = 0;
  double sum_of_squared_errors = 0.0;  ///< Normalised, of right declarations.
};

void add_trial(const Json& trial, Findings& findings) {
  const std::string outcome = trial.at("outcome");
  ++findings.trials;
  findings.right += outcome == "right" ? 1 : 0;
  findings.wrong += outcome == "wrong" ? 1 : 0;
  if ((outcome != "right" && outcome != "wrong") || !trial.contains("confidence")) return;
  findings.declared.add(trial.at("confidence"), outcome == "right");
  if (outcome != "right" || !trial.contains("nees")) return;
  ++findings.squared_errors;
  findings.sum_of_squared_errors += trial.at("nees").get<double>();
}

/// A number of the run's effective.yaml. Only that: reading the whole experiment would take its plugins.
double limit(const StoredRun& run, const std::string& path) {
  const auto setting = run.settings.find(path);
  const std::string text = setting == run.settings.end() ? "" : setting->second.text;
  const double value = number_of<double>(text).value_or(0.0);
  if (!(value > 0.0)) {
    throw ConfigError({{(run.folder / "effective.yaml").string(), 0, 0,
                        fmt::format("{} is no positive number; run the experiment again", path)}});
  }
  return value;
}

void add_folder(const std::filesystem::path& folder, Findings& findings) {
  struct Estimate {
    double confidence, translation_error_m, rotation_error_deg;
  };
  std::map<std::size_t, std::vector<Estimate>> trials;
  const auto add_step = [&](const Json& step) {
    if (!step.contains("confidence") || !step.contains("translation_error_m")) return;
    trials[step.at("trial")].push_back(
        {step.at("confidence"), step.at("translation_error_m"), step.at("rotation_error_deg")});
  };
  const StoredRun run =
      read_results(folder, {[&](const Json& trial) { add_trial(trial, findings); }, add_step});
  require_steps(run);
  const double most_m = limit(run, "evaluation.max_translation_error");
  const double most_deg = limit(run, "evaluation.max_rotation_error_deg");
  // From trial number n the n-th of its steps with an estimate, counted round and round.
  for (const auto& [trial, estimates] : trials) {
    const Estimate& estimate = estimates[trial % estimates.size()];
    findings.believed.add(estimate.confidence,
                          estimate.translation_error_m <= most_m && estimate.rotation_error_deg <= most_deg);
  }
}

void print_bins(const char* title, const Reliability& reliability) {
  answer("\n{}\n", title);
  answer("  confidence    poses   mean    right   95 % interval\n");
  for (const Reliability::Bin& bin : reliability.bins()) {
    answer("  {:.2f} - {:.2f} {:8d}  {:.3f}    {:.3f}   {:.3f} - {:.3f}{}\n", bin.low, bin.high, bin.count,
           bin.mean_confidence, bin.right.value, bin.right.low, bin.right.high, bin.is_off() ? "  off" : "");
  }
}

void reliability(const ReliabilityOptions& options) {
  Findings findings;
  FaultCollector faults;
  for_each_results_folder(options.folders, faults,
                          [&](const std::filesystem::path& folder) { add_folder(folder, findings); });
  faults.report();
  const Proportion wrong = wilson(findings.wrong, findings.trials);
  answer(
      "{} trials: {} right, {} wrong ({:.2f} %, 95 % interval {:.2f} to {:.2f} %), {} without a "
      "declaration\n",
      findings.trials, findings.right, findings.wrong, 100.0 * wrong.value, 100.0 * wrong.low,
      100.0 * wrong.high, findings.trials - findings.right - findings.wrong);
  print_bins("Declared poses", findings.declared);
  print_bins("Best poses, declared or not: one step of each trial", findings.believed);
  if (findings.squared_errors == 0) return;
  const auto n = static_cast<double>(findings.squared_errors);
  // Each has 3 degrees of freedom: mean 3, variance 6.
  answer(
      "\nNormalised error squared of right declarations: {:.2f} in the mean; {:.2f} to {:.2f} if the "
      "covariances are right\n",
      findings.sum_of_squared_errors / n, 3.0 - 1.96 * std::sqrt(6.0 / n), 3.0 + 1.96 * std::sqrt(6.0 / n));
}

}  // namespace

void add_reliability(CLI::App& app, Context& /*context*/) {
  auto options = std::make_shared<ReliabilityOptions>();
  CLI::App* command =
      app.add_subcommand("reliability", "Compare confidences and covariances with what was right.");
  command->add_option("DIR", options->folders, "Folders of results, or folders that hold some")->required();
  command->callback([options] { reliability(*options); });
}

}  // namespace glocal::app
