#include "evaluation/comparison/conclusion.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace glocal {
namespace {

std::string p_text(double p) {
  return p < 0.001 ? "p < 0.001" : fmt::format("p = {:.3f}", p);
}

/// "a", "a and b", "a, b and c".
std::string enumerated(const std::vector<std::string>& items) {
  std::string text;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (i > 0) text += i + 1 == items.size() ? " and " : ", ";
    text += items[i];
  }
  return text;
}

/// What a measure differs by.
std::string effect(const MeasureDifference& difference) {
  const char* unit = difference.measure.unit;
  return fmt::format("{:+.3g}{}{}", difference.shift.value, *unit == '\0' ? "" : " ", unit);
}

/// "a run is significantly better than b in …, and worse in …".
std::string told(const PairComparison& pair, const std::string& baseline,
                 const std::vector<std::string>& better, const std::vector<std::string>& worse) {
  std::string text = pair.variant + " is significantly ";
  if (!better.empty()) text += "better than " + baseline + " in " + enumerated(better);
  if (!better.empty() && !worse.empty()) text += ", and worse in " + enumerated(worse);
  if (better.empty()) text += "worse than " + baseline + " in " + enumerated(worse);
  return text + (worse.empty() || better.empty() ? "; nothing else differs significantly." : ".");
}

}  // namespace

std::string conclude(const PairComparison& pair, const std::string& baseline, std::size_t starts) {
  std::vector<std::string> better, worse;
  for (const OutcomeDifference& outcome : pair.outcomes) {
    if (outcome.p_holm >= significance) continue;
    const bool is_better = (outcome.points.value > 0.0) == outcome.more_is_better;
    (is_better ? better : worse)
        .push_back(fmt::format("{} ({:+.1f} points, {})", outcome.name, outcome.points.value,
                               p_text(outcome.p_holm)));
  }
  std::vector<std::string> too_small;
  for (const MeasureDifference& difference : pair.measures) {
    if (difference.p_holm >= significance) continue;
    const bool is_less = difference.shift.value < 0.0;
    std::vector<std::string>& side = !difference.matters() ? too_small : is_less ? better : worse;
    side.push_back(
        fmt::format("{} ({}, {})", difference.measure.label, effect(difference), p_text(difference.p_holm)));
  }
  const std::string rest =
      too_small.empty() ? "" : fmt::format(" No difference that matters: {}.", enumerated(too_small));
  if (!better.empty() || !worse.empty()) return told(pair, baseline, better, worse) + rest;
  if (!too_small.empty())
    return fmt::format("Nothing that matters differs between {} and {} over {} starts.{}", pair.variant,
                       baseline, starts, rest);
  return fmt::format("Nothing can be told between {} and {}: no difference over {} starts is significant.",
                     pair.variant, baseline, starts);
}

std::vector<std::string> pair_warnings(const PairComparison& pair) {
  std::vector<std::string> few;
  for (const OutcomeDifference& outcome : pair.outcomes) {
    const std::size_t differing = outcome.counts.only_first + outcome.counts.only_second;
    if (least_p(differing) >= significance) few.push_back(fmt::format("{} ({})", outcome.name, differing));
  }
  for (const MeasureDifference& difference : pair.measures) {
    if (least_p(difference.test.nonzero) >= significance)
      few.push_back(fmt::format("{} ({})", difference.measure.label, difference.test.nonzero));
  }
  std::vector<std::string> warnings;
  if (!few.empty()) {
    warnings.push_back(fmt::format(
        "Too few starts at which the two differ: with fewer than 6, no test can find anything; this "
        "is so for {}.",
        enumerated(few)));
  }
  std::vector<std::string> missing;
  for (const Measure& measure : pair.measured) {
    const bool is_there =
        std::any_of(pair.measures.begin(), pair.measures.end(),
                    [&](const MeasureDifference& d) { return d.measure.name == measure.name; });
    if (!is_there) missing.emplace_back(measure.label);
  }
  if (!missing.empty())
    warnings.push_back("There is no start at which both have a value for " + enumerated(missing) + ".");
  return warnings;
}

}  // namespace glocal
