// glocal reliability: whether the confidences and covariances of runs mean what they say.
#include "evaluation/statistics/reliability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/numbers.hpp"
#include "app/standard_streams.hpp"
#include "evaluation/comparison/named_runs.hpp"
#include "evaluation/results/number_text.hpp"
#include "evaluation/results/pose_json.hpp"
#include "evaluation/results/results_folder.hpp"
#include "evaluation/statistics/statistics.hpp"
#include "glocal/error.hpp"
#include "glocal/outcome.hpp"
#include "glocal/pose_covariance.hpp"
#include "glocal/step_result.hpp"

namespace glocal::app {
namespace {

using Json = nlohmann::ordered_json;

struct ReliabilityOptions {
  std::vector<std::string> folders;
  double reference_deviation = 0.0;
  double reference_deviation_deg = 0.0;
};

/// What has been found out in all folders.
struct Findings {
  Reliability declared;
  Reliability believed;  ///< Declared or not; one step of each trial, so that they are independent.
  std::map<Outcome, std::size_t> trials;
  std::vector<double> squared_errors;  ///< Normalised, of right declarations.
};

void add_trial(const Json& trial, Findings& findings) {
  const Outcome outcome = glocal::outcome_of(trial.at("outcome").get<std::string>());
  ++findings.trials[outcome];
  if ((outcome != Outcome::right && outcome != Outcome::wrong) || !trial.contains("confidence")) return;
  findings.declared.add(trial.at("confidence"), outcome == Outcome::right);
}

/// The normalised error squared of a step's estimate against a reference that has errors of its own.
std::optional<double> squared_error(const Json& step, const ReliabilityOptions& options) {
  if (!step.contains("covariance")) return std::nullopt;
  const auto c = step.at("covariance").get<std::array<double, 6>>();
  const double place = options.reference_deviation * options.reference_deviation;
  const double heading = radians(options.reference_deviation_deg) * radians(options.reference_deviation_deg);
  return normalised_error_squared(
      seen_from_above(pose_of(step.at("estimate"))), seen_from_above(pose_of(step.at("reference"))),
      {.xx = c[0] + place, .xy = c[1], .xt = c[2], .yy = c[3] + place, .yt = c[4], .tt = c[5] + heading});
}

/// A number of the run's effective.yaml. Only that: reading the whole experiment would take its plugins.
double limit(const StoredRun& run, const std::string& path) {
  const auto setting = run.settings.find(path);
  const std::string text = setting == run.settings.end() ? "" : setting->second.text;
  const double value = number_of<double>(text).value_or(0.0);
  if (!(value > 0.0)) {
    throw ConfigError(run.folder / "effective.yaml",
                      fmt::format("{} is no positive number; run the experiment again", path));
  }
  return value;
}

void add_folder(const std::filesystem::path& folder, const ReliabilityOptions& options, Findings& findings) {
  struct Estimate {
    double confidence, translation_error_m, rotation_error_deg;
    bool is_declared;
    std::optional<double> squared_error;
  };
  std::map<std::size_t, std::vector<Estimate>> trials;
  const auto add_step = [&](const Json& step) {
    if (!step.contains("confidence") || !step.contains("translation_error_m")) return;
    trials[step.at("trial")].push_back(
        {.confidence = step.at("confidence"),
         .translation_error_m = step.at("translation_error_m"),
         .rotation_error_deg = step.at("rotation_error_deg"),
         .is_declared = step.at("verdict") == to_string(VerdictKind::localized),
         .squared_error = squared_error(step, options)});
  };
  const StoredRun run =
      read_results(folder, {[&](const Json& trial) { add_trial(trial, findings); }, add_step});
  require_steps(run);
  const double most_m = limit(run, "evaluation.max_translation_error");
  const double most_deg = limit(run, "evaluation.max_rotation_error_deg");
  const auto is_right = [&](const Estimate& estimate) {
    return estimate.translation_error_m <= most_m && estimate.rotation_error_deg <= most_deg;
  };
  for (const auto& [trial, estimates] : trials) {
    // From trial number n the n-th of its steps with an estimate, counted round and round.
    const Estimate& believed = estimates[trial % estimates.size()];
    findings.believed.add(believed.confidence, is_right(believed));
    const auto declared = std::find_if(estimates.begin(), estimates.end(),
                                       [](const Estimate& estimate) { return estimate.is_declared; });
    if (declared != estimates.end() && is_right(*declared) && declared->squared_error)
      findings.squared_errors.push_back(*declared->squared_error);
  }
}

/// The share of wrong ones is that of all trials whose declaration could be judged, had there been one.
void print_outcomes(std::map<Outcome, std::size_t> trials) {
  std::size_t all = 0;
  for (const auto& [outcome, n] : trials) all += n;
  const std::size_t not_judged = trials[Outcome::declared];
  std::string text = fmt::format("{} trials: ", all);
  if (all > not_judged) {
    const Proportion wrong = wilson(trials[Outcome::wrong], all - not_judged);
    text += fmt::format("{} right, {} wrong ({:.2f} %, 95 % interval {:.2f} to {:.2f} %), ",
                        trials[Outcome::right], trials[Outcome::wrong], 100.0 * wrong.value,
                        100.0 * wrong.low, 100.0 * wrong.high);
  }
  text += fmt::format("{} without a declaration", trials[Outcome::undecided]);
  if (not_judged > 0) text += fmt::format(", {} declared without a reference pose", not_judged);
  if (trials[Outcome::failed] > 0) text += fmt::format(", {} failed", trials[Outcome::failed]);
  answer("{}\n", text);
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
  for_each_results_folder(options.folders, faults, [&](const std::filesystem::path& folder) {
    add_folder(folder, options, findings);
  });
  faults.report();
  print_outcomes(findings.trials);
  print_bins("Declared poses", findings.declared);
  print_bins("Best poses, declared or not: one step of each trial", findings.believed);
  if (findings.squared_errors.empty()) return;
  const auto n = static_cast<double>(findings.squared_errors.size());
  // Each has 3 degrees of freedom: median 2.366, where the density is 0.188; mean 3, variance 6.
  const double off_median = 1.645 * 0.5 / (0.188 * std::sqrt(n));
  const double off_mean = 1.645 * std::sqrt(6.0 / n);
  answer(
      "\nNormalised error squared of right declarations: {:.2f} in the median, {:.2f} in the mean; if the "
      "covariances are right, {:.2f} to {:.2f} and {:.2f} to {:.2f} in 9 of 10 cases\n",
      quantile(findings.squared_errors, 0.5), mean(findings.squared_errors),
      std::max(0.0, 2.366 - off_median), 2.366 + off_median, 3.0 - off_mean, 3.0 + off_mean);
}

}  // namespace

void add_reliability(CLI::App& app, Context& /*context*/) {
  auto options = std::make_shared<ReliabilityOptions>();
  CLI::App* command =
      app.add_subcommand("reliability", "Compare confidences and covariances with what was right.");
  command->add_option("DIR", options->folders, "Folders of results, or folders that hold some")->required();
  command
      ->add_option("--reference-deviation", options->reference_deviation,
                   "Standard deviation of the reference poses' own errors, m along x and y")
      ->check(within(0.0, 1.0));
  command
      ->add_option("--reference-deviation-deg", options->reference_deviation_deg,
                   "The same of their headings, deg")
      ->check(within(0.0, 45.0));
  command->callback([options] { reliability(*options); });
}

}  // namespace glocal::app
