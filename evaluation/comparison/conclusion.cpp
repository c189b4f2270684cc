#include "evaluation/comparison/conclusion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "evaluation/results/report_blocks.hpp"

namespace glocal {
namespace {

using Phrases = std::vector<std::string>;

/// "a", "a and b", "a, b and c".
std::string enumerated(const Phrases& items) {
  std::string text;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (i > 0) text += i + 1 == items.size() ? " and " : ", ";
    text += items[i];
  }
  return text;
}

std::string count_text(double n, const char* what) {
  return fmt::format("{:g} {}{}", n, what, n == 1.0 ? "" : "s");
}

/// What can be told of right, or of wrong.
enum class Told : std::uint8_t { better, worse, perhaps_small, alike, nothing };

/// Whether all that the difference may be is too small to matter.
bool is_small(const Interval& interval, double smallest) {
  return -smallest < interval.low && interval.high < smallest;
}

Told told_of(const OutcomeDifference& outcome) {
  if (outcome.test.is_significant() && outcome.matters())
    return (outcome.points.value > 0.0) == outcome.more_is_better ? Told::better : Told::worse;
  if (is_small(outcome.points.interval, outcome.smallest)) return Told::alike;
  return outcome.test.is_significant() ? Told::perhaps_small : Told::nothing;
}

std::string points_text(const OutcomeDifference& outcome) {
  const Difference& points = outcome.points;
  return fmt::format("{:+.1f} points, {:+.1f} to {:+.1f}", points.value + 0.0, points.interval.low + 0.0,
                     points.interval.high + 0.0);
}

/// "wrong less often (-3.0 points, -5.1 to -0.9, p = 0.004)".
std::string significant_phrase(const OutcomeDifference& outcome) {
  return fmt::format("{} {} often ({}, {})", outcome.name, outcome.points.value > 0.0 ? "more" : "less",
                     points_text(outcome), p_text(outcome.test.p_holm));
}

/// How many more places would tell.
std::string wanted(double needed, std::size_t places, const std::string& size) {
  const double more = needed - static_cast<double>(places);
  constexpr double most_told = 1e5;
  if (!(more >= 1.0)) return "";
  if (more > most_told) return "; no number of places that anybody has would tell " + size;
  // Two digits are more than is known of the variance.
  const double digits = std::pow(10.0, std::max(0.0, std::floor(std::log10(more)) - 1.0));
  return fmt::format("; about {:.0f} more {} would tell {}", digits * std::round(more / digits),
                     more < 1.5 ? "place" : "places", size);
}

std::string nothing_told(const OutcomeDifference& outcome) {
  if (outcome.test.differing == 0)
    return fmt::format("No place differs in {}: {:.1f} points could have been missed.", outcome.name,
                       outcome.points.interval.high);
  return fmt::format("Nothing can be told of {} ({}{}).", outcome.name, points_text(outcome),
                     wanted(outcome.places_needed, outcome.places, count_text(outcome.smallest, "point")));
}

/// Of wrong and right.
std::string outcomes_text(const PairComparison& pair, const std::string& baseline) {
  Phrases better, worse, alike, rest;
  for (const OutcomeDifference& outcome : pair.outcomes) {
    switch (told_of(outcome)) {
      case Told::better:
        better.push_back(significant_phrase(outcome));
        break;
      case Told::worse:
        worse.push_back(significant_phrase(outcome));
        break;
      case Told::perhaps_small:
        rest.push_back(fmt::format("{} is {}: perhaps by less than {}.", pair.variant,
                                   significant_phrase(outcome), count_text(outcome.smallest, "point")));
        break;
      case Told::alike:
        alike.push_back(fmt::format("{} ({})", outcome.name, points_text(outcome)));
        break;
      case Told::nothing:
        rest.push_back(nothing_told(outcome));
        break;
    }
  }
  std::string text;
  if (!better.empty() && !worse.empty()) {
    text = fmt::format("{} is better and worse than {}: {}, but {}.", pair.variant, baseline,
                       enumerated(better), enumerated(worse));
  } else if (!better.empty() || !worse.empty()) {
    text = fmt::format("{} is {} than {}: {}.", pair.variant, better.empty() ? "worse" : "better", baseline,
                       enumerated(better.empty() ? worse : better));
  } else {
    text = alike.empty() ? fmt::format("{} against {}:", pair.variant, baseline)
                         : fmt::format("{} against {}: no difference that matters in {}.", pair.variant,
                                       baseline, enumerated(alike));
  }
  for (const std::string& sentence : rest) text += " " + sentence;
  return text;
}

std::string with_unit(double value, const Measure& measure) {
  return fmt::format("{:+.3g}{}{}", value + 0.0, *measure.unit == '\0' ? "" : " ", measure.unit);
}

/// "steps to localize (-1.1 in the mean of 42 starts, of which 23 differ, p = 0.002)".
std::string effect(const MeasureDifference& difference) {
  return fmt::format("{} ({} in the mean of {} starts, {}, {})", difference.measure.label,
                     with_unit(difference.mean.value, difference.measure), difference.trials,
                     difference.trials_that_differ == difference.trials
                         ? "which all differ"
                         : fmt::format("of which {} differ", difference.trials_that_differ),
                     p_text(difference.test.p_holm));
}

/// Of steps, errors and times.
std::string measures_text(const PairComparison& pair) {
  Phrases less, more, too_small, perhaps_small, disagree;
  for (const MeasureDifference& difference : pair.measures) {
    if (!difference.test.is_significant()) continue;
    Phrases& side = is_small(difference.mean.interval, difference.smallest) ? too_small
                    : !difference.ranks_agree()                             ? disagree
                    : !difference.matters()                                 ? perhaps_small
                    : difference.mean.value < 0.0                           ? less
                                                                            : more;
    side.push_back(effect(difference));
  }
  std::string text;
  if (!less.empty()) text += " Lower: " + enumerated(less) + ".";
  if (!more.empty()) text += " Higher: " + enumerated(more) + ".";
  if (!disagree.empty())
    text += " At most places the other way than in the mean: " + enumerated(disagree) + ".";
  if (!perhaps_small.empty()) text += " Perhaps too small to matter: " + enumerated(perhaps_small) + ".";
  if (!too_small.empty()) text += " No difference that matters: " + enumerated(too_small) + ".";
  return text;
}

}  // namespace

std::string conclude(const PairComparison& pair, const std::string& baseline) {
  return outcomes_text(pair, baseline) + measures_text(pair);
}

std::vector<std::string> pair_warnings(const PairComparison& pair) {
  Phrases few;
  const auto note = [&](const std::string& name, const TestResult& test) {
    if (test.differing > 0 && !test.has_chance()) few.push_back(fmt::format("{} ({})", name, test.differing));
  };
  for (const OutcomeDifference& outcome : pair.outcomes) note(outcome.name, outcome.test);
  for (const MeasureDifference& difference : pair.measures) note(difference.measure.label, difference.test);
  Phrases warnings;
  if (!few.empty()) {
    warnings.push_back(fmt::format(
        "Too few places at which the two differ: with fewer than 6, no test can find anything; this "
        "is so for {}.",
        enumerated(few)));
  }
  Phrases missing;
  for (const Measure& measure : pair.measured) {
    const bool is_there = std::ranges::any_of(
        pair.measures, [&](const MeasureDifference& d) { return d.measure.name == measure.name; });
    if (!is_there) missing.emplace_back(measure.label);
  }
  if (!missing.empty())
    warnings.push_back("There are no two places at which both have a value for " + enumerated(missing) + ".");
  return warnings;
}

}  // namespace glocal
