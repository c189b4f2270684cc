// Whether the statistics of comparisons keep what they promise, on outcomes of real runs: outcomes.txt has
// how trials with two clusterers ended at the starts of four recorded drives, with four seeds. Comparisons
// are drawn from them.
//   GLOCAL_CALIBRATION=2000 test_evaluation --gtest_filter='Calibration.*'
// makes so many of each and prints the table of docs/comparing.md.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <numeric>
#include <sstream>

#include "evaluation/comparison/comparison.hpp"
#include "evaluation/sweeps/runs.hpp"

namespace glocal::test::calibration_test {
namespace {

/// Trials at one place, with each seed.
using Seeds = std::vector<TrialResult>;
struct RealPlace {
  std::map<std::string, Seeds> methods;
};
using RealCases = std::map<std::string, std::vector<RealPlace>>;

/// "intel 101 kmeans r16 u60 …": r, w or u with the number of steps, for each seed.
RealCases read_outcomes() {
  std::map<std::string, std::map<int, RealPlace>> found;
  std::ifstream file(std::string(GLOCAL_SOURCE_DIR) + "/tests/evaluation/comparison/outcomes.txt");
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string name, method;
    int sample = 0;
    words >> name >> sample >> method;
    for (std::string word; words >> word;) {
      const double steps = std::stod(word.substr(1));
      TrialResult trial = ended(word[0] == 'w' ? Outcome::wrong : Outcome::undecided);
      if (word[0] == 'r') trial = right_after(steps);
      found[name][sample].methods[method].push_back(trial);
    }
  }
  RealCases cases;
  for (auto& [name, places] : found) {
    for (auto& [sample, place] : places) cases[name].push_back(std::move(place));
  }
  return cases;
}

bool is_right(const TrialResult& trial) {
  return trial.outcome == Outcome::right;
}

/// What is compared: outcomes of a place for the first and for the second method. Where both are the same
/// outcomes, no seed counts for both.
struct Scenario {
  std::string first, second;
  bool has_effect = false;

  [[nodiscard]] const Seeds& first_at(const RealPlace& place) const { return place.methods.at(first); }
  /// With the effect that is put in: at every third place half of all right trials stay undecided, and all
  /// others take a fifth of the steps less.
  [[nodiscard]] Seeds second_at(const RealPlace& place, std::size_t number) const {
    Seeds seeds = place.methods.at(second);
    if (!has_effect) return seeds;
    for (TrialResult& trial : seeds) {
      if (!is_right(trial)) continue;
      const bool is_lost = number % 3 == 0 && std::lround(trial.steps) % 2 == 0;
      trial = is_lost ? ended(Outcome::undecided) : right_after(std::round(0.8 * trial.steps));
    }
    return seeds;
  }
  [[nodiscard]] bool shares_seeds() const { return first == second; }
};

/// What comparisons of a scenario differ by in the mean, over all that can be drawn.
struct Truth {
  double right_points = 0.0, steps = 0.0;
};

/// Of so many places, those of a case by its share of all.
std::map<std::string, std::size_t> places_by_case(const RealCases& cases, double share) {
  std::map<std::string, std::size_t> counts;
  for (const auto& [name, places] : cases)
    counts[name] = static_cast<std::size_t>(std::lround(share * static_cast<double>(places.size())));
  return counts;
}

Truth truth_of(const Scenario& scenario, const RealCases& cases,
               const std::map<std::string, std::size_t>& counts) {
  double places_drawn = 0.0, right = 0.0, steps = 0.0, both = 0.0;
  for (const auto& [name, places] : cases) {
    const double weight = static_cast<double>(counts.at(name)) / static_cast<double>(places.size());
    places_drawn += static_cast<double>(counts.at(name));
    for (std::size_t p = 0; p < places.size(); ++p) {
      const Seeds& first = scenario.first_at(places[p]);
      const Seeds second = scenario.second_at(places[p], p);
      double pairs = 0.0, difference = 0.0, both_right = 0.0, steps_difference = 0.0;
      for (std::size_t i = 0; i < first.size(); ++i) {
        for (std::size_t k = 0; k < second.size(); ++k) {
          if (scenario.shares_seeds() && i == k) continue;
          pairs += 1.0;
          difference += (is_right(second[k]) ? 1.0 : 0.0) - (is_right(first[i]) ? 1.0 : 0.0);
          if (!is_right(first[i]) || !is_right(second[k])) continue;
          both_right += 1.0;
          steps_difference += second[k].steps - first[i].steps;
        }
      }
      right += weight * difference / pairs;
      both += weight * both_right / pairs;
      steps += weight * steps_difference / pairs;
    }
  }
  return {100.0 * right / places_drawn, steps / both};
}

std::vector<std::size_t> shuffled(std::size_t n, Rng& rng) {
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = n; i > 1; --i)
    std::swap(order[i - 1], order[rng.below(static_cast<std::uint32_t>(i))]);
  return order;
}

/// Places drawn with replacement within each case, with some of their seeds.
std::vector<NamedRun> drawn(const Scenario& scenario, const RealCases& cases,
                            const std::map<std::string, std::size_t>& counts, std::size_t seeds, Rng& rng) {
  std::vector<NamedRun> runs;
  for (const auto& [name, places] : cases) {
    const std::size_t begin = runs.size();
    for (const char* method : {"first", "second"}) {
      for (std::size_t s = 0; s < seeds; ++s)
        runs.push_back(sweep_run({.setting = method, .case_name = name, .seed = s}, ""));
    }
    for (std::size_t n = 0; n < counts.at(name); ++n) {
      const std::size_t p = rng.below(static_cast<std::uint32_t>(places.size()));
      const Seeds& first = scenario.first_at(places[p]);
      const Seeds second = scenario.second_at(places[p], p);
      const std::vector<std::size_t> order = shuffled(first.size(), rng);
      const std::vector<std::size_t> other = scenario.shares_seeds() ? order : shuffled(second.size(), rng);
      const TrialStart start{static_cast<std::int64_t>(n), 100.0 * static_cast<double>(n), 0.0};
      for (std::size_t s = 0; s < seeds; ++s) {
        runs[begin + s].results.trials[start] = first[order[s]];
        runs[begin + seeds + s].results.trials[start] = second[other[second.size() - 1 - s]];
      }
    }
  }
  return runs;
}

/// McNemar's exact test, from binomials.
double mcnemar(std::size_t less, std::size_t more) {
  const double n = static_cast<double>(less + more);
  double tail = 0.0;
  for (std::size_t k = 0; k <= std::min(less, more); ++k) {
    const auto x = static_cast<double>(k);
    tail +=
        std::exp(std::lgamma(n + 1.0) - std::lgamma(x + 1.0) - std::lgamma(n - x + 1.0) - n * std::log(2.0));
  }
  return std::min(1.0, 2.0 * tail);
}

/// Of many comparisons, in per cent.
struct Found {
  double right = 0.0, steps = 0.0, any_holm = 0.0;  ///< p < 0.05: of one test, and of any after Holm.
  double right_holm = 0.0, right_pairs = 0.0;       ///< After Holm: now, and as if each trial were a place.
  double covers_right = 0.0, covers_steps = 0.0;    ///< 95 % intervals with the truth.
  std::size_t places = 0;
};

bool contains(const Interval& interval, double value) {
  return interval.low - 1e-9 <= value && value <= interval.high + 1e-9;
}

Found repeat(const Scenario& scenario, const RealCases& cases, double share, std::size_t seeds,
             int repetitions) {
  const auto counts = places_by_case(cases, share);
  const Truth truth = truth_of(scenario, cases, counts);
  Rng rng(42);
  Found found;
  const double one = 100.0 / repetitions;
  for (int i = 0; i < repetitions; ++i) {
    const Comparison comparison = compare(drawn(scenario, cases, counts, seeds, rng), 0, measures_but_time());
    const PairComparison& pair = comparison.pairs.front();
    const OutcomeDifference& wrong = pair.outcomes[0];
    const OutcomeDifference& right = pair.outcomes[1];
    const MeasureDifference& steps = pair.measures[0];
    found.places = comparison.places;
    found.right += right.test.p < significance ? one : 0.0;
    found.steps += steps.test.p < significance ? one : 0.0;
    found.any_holm += wrong.test.is_significant() || right.test.is_significant() ? one : 0.0;
    found.right_holm += right.test.is_significant() ? one : 0.0;
    const auto of_pairs = [](const OutcomeDifference& o) {
      return mcnemar(o.counts.only_baseline, o.counts.only_variant);
    };
    found.right_pairs += holm({of_pairs(right), of_pairs(wrong)})[0] < significance ? one : 0.0;
    found.covers_right += contains(right.points.interval, truth.right_points) ? one : 0.0;
    found.covers_steps += contains(steps.mean.interval, truth.steps) ? one : 0.0;
  }
  return found;
}

const Scenario& itself() {
  static const Scenario scenario{"dbscan", "dbscan"};
  return scenario;
}
const Scenario& with_effect() {
  static const Scenario scenario{"dbscan", "dbscan", true};
  return scenario;
}

int repetitions_or(int least) {
  const char* wanted = std::getenv("GLOCAL_CALIBRATION");
  return wanted == nullptr ? least : std::max(least, std::atoi(wanted));
}

TEST(Calibration, PrintsItsTable) {
  const int repetitions = repetitions_or(0);
  if (repetitions == 0) GTEST_SKIP() << "GLOCAL_CALIBRATION says how many comparisons to make";
  const RealCases cases = read_outcomes();
  fmt::print(
      "| compared | places × seeds | p < 0.05: right | steps | right, after Holm | McNemar's, of trials, "
      "after Holm | interval holds: right | steps |\n|---|---|---:|---:|---:|---:|---:|---:|\n");
  const std::vector<std::pair<const char*, Scenario>> scenarios = {
      {"a method with itself", itself()},
      {"with an effect put in", with_effect()},
      {"k-means and DBSCAN", {"kmeans", "dbscan"}}};
  for (const auto& [name, scenario] : scenarios) {
    for (const auto& [share, seeds] : {std::pair{0.5, 1}, {0.5, 2}, {3.0, 1}, {3.0, 2}}) {
      const Found f = repeat(scenario, cases, share, static_cast<std::size_t>(seeds), repetitions);
      fmt::print("| {} | {} × {} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.1f} |\n", name, f.places,
                 seeds, f.right, f.steps, f.right_holm, f.right_pairs, f.covers_right, f.covers_steps);
    }
  }
}

constexpr int few_repetitions = 100;

TEST(Calibration, AMethodIsHardlyEverFoundToDifferFromItself) {
  const RealCases cases = read_outcomes();
  ASSERT_EQ(cases.size(), 4U);
  for (const std::size_t seeds : {std::size_t{1}, std::size_t{2}}) {
    const Found found = repeat(itself(), cases, 0.5, seeds, few_repetitions);
    // At most 5 %; with 100 comparisons two standard deviations are 4 %.
    EXPECT_LE(found.right, 9.0);
    EXPECT_LE(found.steps, 9.0);
    EXPECT_LE(found.any_holm, 9.0);
  }
}

TEST(Calibration, IntervalsHoldTheEffectThatIsPutIn) {
  const RealCases cases = read_outcomes();
  for (const std::size_t seeds : {std::size_t{1}, std::size_t{2}}) {
    const Found found = repeat(with_effect(), cases, 0.5, seeds, few_repetitions);
    EXPECT_GE(found.covers_right, 90.0);
    EXPECT_GE(found.covers_steps, 90.0);
    EXPECT_LE(found.covers_right, 99.5);
  }
}

TEST(Calibration, FindsAsMuchAsTestsOfSinglePairs) {
  const RealCases cases = read_outcomes();
  const Found one = repeat(with_effect(), cases, 0.5, 1, few_repetitions);
  EXPECT_GE(one.right_holm, one.right_pairs);
  EXPECT_GT(repeat(with_effect(), cases, 0.5, 2, few_repetitions).right, one.right) << "more seeds tell more";
}

}  // namespace
}  // namespace glocal::test::calibration_test
