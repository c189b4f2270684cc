#include "evaluation/comparison/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "evaluation/comparison/comparability.hpp"
#include "evaluation/comparison/conclusion.hpp"
#include "glocal/error.hpp"

namespace glocal {
namespace {

/// The same random numbers in every comparison; each interval has a stream of its own.
constexpr std::uint64_t bootstrap_seed = 1;
enum class Stream : std::uint8_t { outcome, median, mean };

Rng stream(Stream kind, std::size_t index) {
  return Rng(bootstrap_seed).stream({static_cast<std::uint64_t>(kind), index});
}

bool is_right(const TrialResult& trial) {
  return trial.outcome == Outcome::right;
}

bool is_wrong(const TrialResult& trial) {
  return trial.outcome == Outcome::wrong;
}

/// A value that counts only if the answer was right: how soon a wrong one was given says nothing.
template <class Value>
std::optional<double> if_right(const TrialResult& trial, Value value) {
  return is_right(trial) ? std::optional<double>(value) : std::nullopt;
}

TrialsByStart trials_at(const std::vector<TrialStart>& starts, const StoredRun& results) {
  TrialsByStart trials;
  for (const TrialStart& start : starts) trials.push_back(&results.trials.at(start));
  return trials;
}

RunFigures figures(const NamedRun& run, const TrialsByStart& trials, std::span<const Measure> measured) {
  RunFigures figures{run.name, run.results.folder.string(), run.results.experiment, run.results.seed};
  for (const TrialResult* trial : trials) {
    figures.right += is_right(*trial) ? 1 : 0;
    figures.wrong += is_wrong(*trial) ? 1 : 0;
  }
  figures.undecided = trials.size() - figures.right - figures.wrong;
  figures.success = wilson(figures.right, trials.size());
  figures.false_rate = wilson(figures.wrong, trials.size());
  for (const Measure& measure : measured) {
    std::vector<double> values;
    for (const TrialResult* trial : trials) {
      if (const auto value = measure.of(*trial)) values.push_back(*value);
    }
    figures.medians.push_back(median_if_any(std::move(values)));
  }
  return figures;
}

OutcomeDifference compare_outcome(OutcomeDifference result, bool (*has)(const TrialResult&),
                                  std::size_t index, const TrialsByStart& baseline,
                                  const TrialsByStart& variant) {
  std::vector<double> differences;
  PairedCounts& counts = result.counts;
  for (std::size_t i = 0; i < baseline.size(); ++i) {
    const bool first = has(*baseline[i]);
    const bool second = has(*variant[i]);
    ++(first ? (second ? counts.both : counts.only_first) : (second ? counts.only_second : counts.neither));
    differences.push_back(100.0 * (static_cast<double>(second) - static_cast<double>(first)));
  }
  result.points = {mean(differences), bootstrap(differences, mean, stream(Stream::outcome, index))};
  const Interval newcombe = newcombe_paired(counts);
  result.newcombe_points = {100.0 * newcombe.low, 100.0 * newcombe.high};
  result.p = mcnemar_exact(counts.only_first, counts.only_second);
  return result;
}

double median(const std::vector<double>& values) {
  return quantile(values, 0.5);
}

MeasureDifference compare_measure(const Measure& measure, std::size_t index, const TrialsByStart& baseline,
                                  const TrialsByStart& variant) {
  std::vector<double> first, second, differences;
  for (std::size_t i = 0; i < baseline.size(); ++i) {
    const auto a = measure.of(*baseline[i]);
    const auto b = measure.of(*variant[i]);
    if (!a || !b) continue;
    first.push_back(*a);
    second.push_back(*b);
    const double difference = *b - *a;
    const bool is_rounding = std::abs(difference) <= rounding * std::max(std::abs(*a), std::abs(*b));
    differences.push_back(is_rounding ? 0.0 : difference);
  }
  MeasureDifference result;
  result.measure = measure;
  result.starts = differences.size();
  if (differences.empty()) return result;
  result.baseline_median = median(first);
  result.variant_median = median(second);
  result.median = {median(differences), bootstrap(differences, median, stream(Stream::median, index))};
  result.mean = {mean(differences), bootstrap(differences, mean, stream(Stream::mean, index))};
  result.test = wilcoxon_signed_rank(differences);
  result.shift = hodges_lehmann(differences);
  result.smallest = measure.smallest * (measure.is_share ? std::abs(result.baseline_median) : 1.0);
  return result;
}

/// Of these measures those that can be compared between two runs. Times come last.
std::span<const Measure> comparable(std::span<const Measure> measured, const NamedRun& run,
                                    const NamedRun& baseline) {
  if (!why_times_differ(run, baseline)) return measured;
  return measured.first(std::min(measured.size(), measures_but_time().size()));
}

PairComparison compare_pair(const std::string& name, const TrialsByStart& baseline,
                            const TrialsByStart& variant, std::span<const Measure> measured) {
  PairComparison pair;
  pair.variant = name;
  pair.measured = measured;
  pair.outcomes = {
      compare_outcome({.name = "right", .more_is_better = true}, is_right, 0, baseline, variant),
      compare_outcome({.name = "wrong", .more_is_better = false}, is_wrong, 1, baseline, variant)};
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const MeasureDifference difference = compare_measure(measured[i], i, baseline, variant);
    if (difference.starts > 0) pair.measures.push_back(difference);
  }
  return pair;
}

/// Corrects the tests of a family, which `tests` leads to: each has a p and a place for the corrected one.
struct TestOfFamily {
  double p;
  double* p_holm;
};
void correct(const std::vector<TestOfFamily>& family) {
  std::vector<double> p;
  std::transform(family.begin(), family.end(), std::back_inserter(p),
                 [](const TestOfFamily& t) { return t.p; });
  const std::vector<double> adjusted = holm(p);
  for (std::size_t i = 0; i < family.size(); ++i) *family[i].p_holm = adjusted[i];
}

void correct(Comparison& comparison) {
  std::vector<TestOfFamily> outcomes, measures;
  for (PairComparison& pair : comparison.pairs) {
    for (OutcomeDifference& outcome : pair.outcomes) outcomes.push_back({outcome.p, &outcome.p_holm});
    for (MeasureDifference& measure : pair.measures) measures.push_back({measure.test.p, &measure.p_holm});
  }
  correct(outcomes);
  correct(measures);
  comparison.outcome_tests = outcomes.size();
  comparison.measure_tests = measures.size();
}

}  // namespace

std::span<const Measure> measures() {
  static constexpr std::array<Measure, 5> all = {{
      {"steps", "", "steps to localize", 0.5, false,
       [](const TrialResult& t) { return if_right(t, t.steps); }},
      {"distance_m", "m", "way to localize", 0.1, false,
       [](const TrialResult& t) { return if_right(t, t.distance_m); }},
      {"translation_error_m", "m", "translation error", 0.01, false,
       [](const TrialResult& t) { return if_right(t, t.translation_error_m); }},
      {"rotation_error_deg", "deg", "rotation error", 0.1, false,
       [](const TrialResult& t) { return if_right(t, t.rotation_error_deg); }},
      {"step_cpu_ms", "ms", "CPU time of a step", 0.05, true,
       [](const TrialResult& t) { return t.step_cpu_ms; }},
  }};
  return all;
}

std::span<const Measure> measures_but_time() {
  return measures().first(measures().size() - 1);
}

std::vector<TrialStart> shared_starts(const std::vector<NamedRun>& runs) {
  std::vector<TrialStart> shared;
  for (const auto& entry : runs.front().results.trials) {
    const TrialStart& start = entry.first;
    const bool all = std::all_of(runs.begin(), runs.end(),
                                 [&](const NamedRun& run) { return run.results.trials.contains(start); });
    if (all) shared.push_back(start);
  }
  if (shared.empty()) {
    std::vector<Fault> faults;
    for (const NamedRun& run : runs) {
      faults.push_back(
          {run.results.folder.string(), 0, 0,
           fmt::format("none of its {} starts is one of all runs to compare; run all experiments "
                       "with the same observations and trials",
                       run.results.trials.size())});
    }
    throw ConfigError(std::move(faults));
  }
  return shared;
}

Comparison compare(const std::vector<NamedRun>& runs, std::size_t baseline,
                   std::span<const Measure> measured) {
  const std::vector<TrialStart> starts = shared_starts(runs);
  std::vector<TrialsByStart> trials;
  for (const NamedRun& run : runs) trials.push_back(trials_at(starts, run.results));

  Comparison comparison;
  comparison.baseline = runs[baseline].name;
  comparison.starts = starts.size();
  comparison.measured = measured;
  comparison.warnings = comparability_warnings(runs, baseline, starts, trials);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    comparison.runs.push_back(figures(runs[i], trials[i], measured));
    if (i == baseline) continue;
    comparison.pairs.push_back(compare_pair(runs[i].name, trials[baseline], trials[i],
                                            comparable(measured, runs[i], runs[baseline])));
  }
  correct(comparison);
  for (PairComparison& pair : comparison.pairs) {
    pair.conclusion = conclude(pair, comparison.baseline, comparison.starts);
    pair.warnings = pair_warnings(pair);
  }
  return comparison;
}

}  // namespace glocal
