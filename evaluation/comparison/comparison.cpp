#include "evaluation/comparison/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <set>

#include "evaluation/comparison/comparability.hpp"
#include "evaluation/comparison/conclusion.hpp"
#include "evaluation/comparison/methods.hpp"
#include "glocal/error.hpp"

namespace glocal {
namespace {

/// The same random numbers in every comparison; the interval of each measure has a stream of its own.
constexpr std::uint64_t bootstrap_seed = 1;

using Trials = std::vector<const TrialResult*>;

bool is_right(const TrialResult& trial) {
  return trial.outcome == Outcome::right;
}

bool is_wrong(const TrialResult& trial) {
  return trial.outcome == Outcome::wrong;
}

bool is_undecided(const TrialResult& trial) {
  return !is_right(trial) && !is_wrong(trial);
}

/// A value that counts only if the answer was right: how soon a wrong one was given says nothing.
template <class Value>
std::optional<double> if_right(const TrialResult& trial, Value value) {
  return is_right(trial) ? std::optional<double>(value) : std::nullopt;
}

using HasProperty = bool (*)(const TrialResult&);

/// Of a method, over all places.
Proportion share_of(HasProperty has, const PairedTrials& paired, const Trials& trials) {
  std::vector<TrialCluster> clusters;
  for (const PairedTrials::Place& place : paired.places) {
    TrialCluster& cluster = clusters.emplace_back();
    cluster.trials = place.end - place.begin;
    for (std::size_t t = place.begin; t < place.end; ++t) cluster.successes += has(*trials[t]) ? 1 : 0;
  }
  return wilson_of_clusters(clusters);
}

void count(const TrialResult& trial, OutcomeCounts& counts) {
  ++(is_right(trial) ? counts.right : is_wrong(trial) ? counts.wrong : counts.undecided);
}

std::optional<double> median_of(const Measure& measure, std::span<const TrialResult* const> trials) {
  std::vector<double> values;
  for (const TrialResult* trial : trials) {
    if (const auto value = measure.of(*trial)) values.push_back(*value);
  }
  return median_if_any(std::move(values));
}

MethodFigures method_figures(const std::vector<NamedRun>& runs, const Method& method, std::size_t number,
                             const PairedTrials& paired, std::span<const Measure> measured) {
  const Trials& trials = paired.results[number];
  MethodFigures figures{.name = method.name, .experiment = {}, .folders = {}, .outcomes = {}};
  for (const PairedTrials::Cell& cell : paired.cells) {
    const StoredRun& run = runs[cell.runs[number]].results;
    figures.experiment = run.experiment;
    figures.folders.push_back(run.folder.string());
  }
  for (const TrialResult* trial : trials) count(*trial, figures.outcomes);
  figures.success = share_of(is_right, paired, trials);
  figures.false_rate = share_of(is_wrong, paired, trials);
  figures.undecided_rate = share_of(is_undecided, paired, trials);
  for (const Measure& measure : measured) figures.medians.push_back(median_of(measure, trials));
  return figures;
}

/// What is compared: two methods at some of the places.
struct Pair {
  const PairedTrials& paired;
  std::span<const PairedTrials::Place> places;
  const Trials &baseline, &variant;
  const std::vector<bool>& has_times;  ///< Of each cell: whether its times can be compared.
};

PlaceOutcomes outcomes_at(const PairedTrials::Place& place, const Pair& pair, HasProperty has) {
  PlaceOutcomes outcomes{place.case_number, place.end - place.begin, 0, 0};
  for (std::size_t t = place.begin; t < place.end; ++t) {
    const bool first = has(*pair.baseline[t]);
    const bool second = has(*pair.variant[t]);
    outcomes.only_first += first && !second ? 1 : 0;
    outcomes.only_second += second && !first ? 1 : 0;
  }
  return outcomes;
}

Difference points_of(const std::vector<PlaceOutcomes>& places) {
  double difference = 0.0, trials = 0.0;
  for (const PlaceOutcomes& place : places) {
    difference += static_cast<double>(place.only_second) - static_cast<double>(place.only_first);
    trials += static_cast<double>(place.trials);
  }
  const Interval interval = interval_of_shares(places);
  return {100.0 * difference / trials, {100.0 * interval.low, 100.0 * interval.high}};
}

Difference points_of(const Pair& pair, HasProperty has) {
  std::vector<PlaceOutcomes> places;
  for (const PairedTrials::Place& place : pair.places) places.push_back(outcomes_at(place, pair, has));
  return points_of(places);
}

OutcomeDifference compare_outcome(OutcomeDifference result, HasProperty has, const Pair& pair) {
  std::vector<PlaceOutcomes> places;
  std::vector<long> sums;
  for (const PairedTrials::Place& place : pair.places) {
    const PlaceOutcomes& outcomes = places.emplace_back(outcomes_at(place, pair, has));
    sums.push_back(static_cast<long>(outcomes.only_second) - static_cast<long>(outcomes.only_first));
    result.places_more += sums.back() > 0 ? 1 : 0;
    result.places_less += sums.back() < 0 ? 1 : 0;
    result.counts.only_baseline += outcomes.only_first;
    result.counts.only_variant += outcomes.only_second;
    for (std::size_t t = place.begin; t < place.end; ++t) {
      if (has(*pair.baseline[t]) == has(*pair.variant[t]))
        ++(has(*pair.baseline[t]) ? result.counts.both : result.counts.neither);
    }
  }
  result.places = places.size();
  result.points = points_of(places);
  const SignFlips flips = sign_flip_test(sums);
  result.test = {flips.differing, flips.p, 1.0};
  result.places_needed = places_to_find(result.smallest, places.size(), result.points.interval);
  return result;
}

double median(const std::vector<double>& values) {
  return quantile(values, 0.5);
}

/// 0 where a difference is nothing but rounding.
double difference_of(double first, double second) {
  const double difference = second - first;
  return std::abs(difference) <= rounding * std::max(std::abs(first), std::abs(second)) ? 0.0 : difference;
}

MeasureDifference compare_measure(const Measure& measure, std::size_t index, const Pair& pair) {
  const bool is_time = index >= measures_but_time().size();
  std::vector<double> first, second, differences, of_places;
  std::vector<PlaceSum> sums;
  for (const PairedTrials::Place& place : pair.places) {
    PlaceSum sum{place.case_number, 0, 0.0};
    for (std::size_t t = place.begin; t < place.end; ++t) {
      const auto a = measure.of(*pair.baseline[t]);
      const auto b = measure.of(*pair.variant[t]);
      if (!a || !b || (is_time && !pair.has_times[pair.paired.trials[t].cell])) continue;
      first.push_back(*a);
      second.push_back(*b);
      differences.push_back(difference_of(*a, *b));
      ++sum.trials;
      sum.sum += differences.back();
    }
    if (sum.trials == 0) continue;
    sums.push_back(sum);
    of_places.push_back(sum.sum / static_cast<double>(sum.trials));
  }
  MeasureDifference result;
  result.measure = measure;
  result.places = sums.size();
  result.trials = differences.size();
  if (sums.size() < 2) return result;
  result.baseline_median = median(first);
  result.variant_median = median(second);
  result.mean = {mean(differences), interval_of_mean(sums, Rng(bootstrap_seed).stream({index}))};
  result.median = median(differences);
  std::vector<double> differing;
  std::ranges::copy_if(differences, std::back_inserter(differing), [](double d) { return d != 0.0; });
  result.trials_that_differ = differing.size();
  result.mean_of_those = mean(differing);
  result.ranks = wilcoxon_signed_rank(of_places);
  result.test = {result.ranks.nonzero, result.ranks.p, 1.0};
  result.smallest = measure.smallest * (measure.is_share ? std::abs(result.baseline_median) : 1.0);
  if (result.smallest > 0.0)
    result.places_needed = places_to_find(result.smallest, sums.size(), result.mean.interval);
  return result;
}

PairComparison compare_pair(const std::string& name, std::span<const Measure> measured, const Pair& pair) {
  PairComparison result;
  result.variant = name;
  result.measured = measured;
  result.outcomes = {
      compare_outcome({.name = "wrong", .more_is_better = false, .smallest = 1.0}, is_wrong, pair),
      compare_outcome({.name = "right", .more_is_better = true, .smallest = 2.0}, is_right, pair)};
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const MeasureDifference difference = compare_measure(measured[i], i, pair);
    if (difference.places > 1) result.measures.push_back(difference);
  }
  return result;
}

/// Corrects the tests of a family, but for those that have no chance: whether they have follows from how many
/// places differ, not from which way, so that it keeps the promise of the correction (Tarone 1990). Tells how
/// many there are.
std::size_t correct(const std::vector<TestResult*>& family) {
  std::vector<TestResult*> tests;
  std::ranges::copy_if(family, std::back_inserter(tests), &TestResult::has_chance);
  std::vector<double> p;
  std::ranges::transform(tests, std::back_inserter(p), &TestResult::p);
  const std::vector<double> adjusted = holm(p);
  for (std::size_t i = 0; i < tests.size(); ++i) tests[i]->p_holm = adjusted[i];
  return tests.size();
}

void correct(Comparison& comparison) {
  std::vector<TestResult*> outcomes, measures;
  for (PairComparison& pair : comparison.pairs) {
    for (OutcomeDifference& outcome : pair.outcomes) outcomes.push_back(&outcome.test);
    for (MeasureDifference& measure : pair.measures) measures.push_back(&measure.test);
  }
  comparison.outcome_tests = correct(outcomes);
  comparison.measure_tests = correct(measures);
}

/// The method that a run is of.
std::size_t method_of(std::size_t run, const std::vector<Method>& methods) {
  const auto has_run = [&](const Method& method) {
    return std::ranges::find(method.runs, run, &Method::Run::index) != method.runs.end();
  };
  return static_cast<std::size_t>(std::ranges::find_if(methods, has_run) - methods.begin());
}

/// Of these measures those that can be compared in at least one cell. Times come last.
std::span<const Measure> comparable(std::span<const Measure> measured, const std::vector<bool>& has_times) {
  if (std::find(has_times.begin(), has_times.end(), true) != has_times.end()) return measured;
  return measured.first(std::min(measured.size(), measures_but_time().size()));
}

std::vector<bool> cells_with_times(const std::vector<NamedRun>& runs, const PairedTrials& paired,
                                   std::size_t variant, std::size_t baseline) {
  std::vector<bool> has_times;
  for (const PairedTrials::Cell& cell : paired.cells)
    has_times.push_back(!why_times_differ(runs[cell.runs[variant]], runs[cell.runs[baseline]]).has_value());
  return has_times;
}

/// Of each case in turn: its places, which lie beside each other.
using PlacesByCase = std::vector<std::span<const PairedTrials::Place>>;
PlacesByCase places_by_case(const PairedTrials& paired) {
  PlacesByCase result;
  const auto& places = paired.places;
  for (std::size_t begin = 0, end = 0; begin < places.size(); begin = end) {
    while (end < places.size() && places[end].case_number == places[begin].case_number) ++end;
    result.emplace_back(places.data() + begin, end - begin);
  }
  return result;
}

/// What is compared, without any method.
Comparison counted_trials(const PairedTrials& paired, const PlacesByCase& cases) {
  Comparison comparison;
  comparison.starts = paired.trials.size();
  comparison.places = paired.places.size();
  std::set<std::uint64_t> seeds;
  for (const PairedTrials::Cell& cell : paired.cells) seeds.insert(cell.seed);
  comparison.seeds.assign(seeds.begin(), seeds.end());
  for (const auto& places : cases) comparison.cases.push_back(paired.cases[places.front().case_number]);
  return comparison;
}

CaseFigures case_figures(const Pair& pair, bool is_baseline) {
  CaseFigures figures{};
  const std::size_t begin = pair.places.front().begin;
  const std::span<const TrialResult* const> trials(pair.variant.data() + begin,
                                                   pair.places.back().end - begin);
  for (const TrialResult* trial : trials) count(*trial, figures.outcomes);
  figures.median_steps = median_of(measures().front(), trials);
  if (is_baseline) return figures;
  figures.right_points = points_of(pair, is_right);
  figures.wrong_points = points_of(pair, is_wrong);
  return figures;
}

}  // namespace

std::span<const Measure> measures() {
  static constexpr std::array<Measure, 5> all = {{
      {"steps", "", "steps to localize", "steps", 0.5, false,
       [](const TrialResult& t) { return if_right(t, t.steps); }},
      {"distance_m", "m", "way to localize", "way, m", 0.1, false,
       [](const TrialResult& t) { return if_right(t, t.distance_m); }},
      {"translation_error_m", "m", "translation error", "error, m", 0.01, false,
       [](const TrialResult& t) { return if_right(t, t.translation_error_m); }},
      {"rotation_error_deg", "deg", "rotation error", "deg", 0.1, false,
       [](const TrialResult& t) { return if_right(t, t.rotation_error_deg); }},
      {"step_cpu_ms", "ms", "CPU time of a step", "CPU, ms", 0.05, true,
       [](const TrialResult& t) { return t.step_cpu_ms; }},
  }};
  return all;
}

std::span<const Measure> measures_but_time() {
  return measures().first(measures().size() - 1);
}

bool has_time(std::span<const Measure> measured) {
  return measured.size() > measures_but_time().size();
}

Comparison compare(const std::vector<NamedRun>& runs, std::size_t baseline_run,
                   std::span<const Measure> measured) {
  const std::vector<Method> methods = methods_of(runs);
  if (methods.size() < 2)
    throw ConfigError(
        runs.front().results.folder,
        fmt::format("all runs are of one method, {}; name those of another one, too", methods.front().name));
  const PairedTrials paired = pair_trials(runs, methods);
  if (paired.trials.empty()) refuse_unpaired(runs, methods, paired);
  const std::size_t baseline = method_of(baseline_run, methods);

  const auto cases = places_by_case(paired);
  Comparison comparison = counted_trials(paired, cases);
  comparison.baseline = methods[baseline].name;
  comparison.measured = measured;
  comparison.warnings = comparability_warnings(runs, methods, baseline, paired, has_time(measured));
  for (std::size_t m = 0; m < methods.size(); ++m) {
    comparison.methods.push_back(method_figures(runs, methods[m], m, paired, measured));
    const std::vector<bool> has_times = cells_with_times(runs, paired, m, baseline);
    // A median of times is one of all cells.
    auto& medians = comparison.methods.back().medians;
    if (std::ranges::find(has_times, false) != has_times.end())
      for (std::size_t i = measures_but_time().size(); i < medians.size(); ++i) medians[i].reset();
    for (const auto& places : cases)
      comparison.methods.back().cases.push_back(case_figures(
          {paired, places, paired.results[baseline], paired.results[m], has_times}, m == baseline));
    if (m == baseline) continue;
    comparison.pairs.push_back(
        compare_pair(methods[m].name, comparable(measured, has_times),
                     {paired, paired.places, paired.results[baseline], paired.results[m], has_times}));
  }
  correct(comparison);
  for (PairComparison& pair : comparison.pairs) {
    pair.conclusion = conclude(pair, comparison.baseline);
    pair.warnings = pair_warnings(pair);
  }
  return comparison;
}

}  // namespace glocal
