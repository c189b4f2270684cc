#include "evaluation/comparison/comparison_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

namespace glocal {
namespace {

// Adding 0 turns -0 into 0.
std::string number(double value) {
  return fmt::format("{:.4g}", value + 0.0);
}
std::string signed_number(double value) {
  return fmt::format("{:+.3g}", value + 0.0);
}
std::string range(const Interval& interval) {
  return signed_number(interval.low) + " to " + signed_number(interval.high);
}
std::string points(const std::optional<Difference>& difference) {
  if (!difference) return "";
  return fmt::format("{:+.1f} ({:+.1f} to {:+.1f})", difference->value + 0.0, difference->interval.low + 0.0,
                     difference->interval.high + 0.0);
}
/// Of a test that is no part of its family.
std::string p_holm(const TestResult& test) {
  return test.has_chance() ? p_value(test.p_holm) : "-";
}
std::string with_unit(const Measure& measure) {
  return *measure.unit == '\0' ? measure.label : fmt::format("{}, {}", measure.label, measure.unit);
}
template <class TestedDifference>
const char* star(const TestedDifference& d) {
  return d.test.is_significant() && d.matters() ? "*" : "";
}
/// "83.3 (61-94)": in per cent.
std::string share(const Proportion& proportion) {
  return fmt::format("{:.1f} ({:.0f}-{:.0f})", 100.0 * proportion.value, 100.0 * proportion.low,
                     100.0 * proportion.high);
}

std::string heading(const Comparison& comparison) {
  const bool has_cases = comparison.cases.size() > 1 || !comparison.cases.front().empty();
  return fmt::format("{} compared with {}, by {}: {}{}{}", counted(comparison.methods.size() - 1, "method"),
                     comparison.baseline, counted(comparison.starts, "start"),
                     counted(comparison.places, "place"),
                     has_cases ? fmt::format(" of {}", counted(comparison.cases.size(), "case")) : "",
                     comparison.seeds.size() > 1 ? fmt::format(", {} seeds", comparison.seeds.size()) : "");
}

Table methods_table(const Comparison& comparison) {
  Table table{{"method", "starts", "right, %", "wrong, %", "undecided, %"}, {}};
  for (const Measure& measure : comparison.measured) table.header.emplace_back(measure.column);
  for (const MethodFigures& method : comparison.methods) {
    table.rows.push_back({method.name, std::to_string(comparison.starts), share(method.success),
                          share(method.false_rate), share(method.undecided_rate)});
    for (const std::optional<double>& median : method.medians)
      table.rows.back().push_back(median ? fmt::format("{:.3g}", *median) : "-");
  }
  return table;
}

Table cases_table(const Comparison& comparison) {
  Table table{{"case", "method", "right", "wrong", "undecided", "steps", "right, points (95 %)",
               "wrong, points (95 %)"},
              {}};
  for (std::size_t c = 0; c < comparison.cases.size(); ++c) {
    for (const MethodFigures& method : comparison.methods) {
      const CaseFigures& figures = method.cases[c];
      table.rows.push_back({&method == &comparison.methods.front() ? comparison.cases[c] : "", method.name,
                            std::to_string(figures.outcomes.right), std::to_string(figures.outcomes.wrong),
                            std::to_string(figures.outcomes.undecided),
                            figures.median_steps ? number(*figures.median_steps) : "-",
                            points(figures.right_points), points(figures.wrong_points)});
    }
  }
  return table;
}

Table outcomes_table(const PairComparison& pair, const std::string& baseline) {
  Table table{{"outcome", "only " + baseline, "only " + pair.variant, "places", "more", "fewer",
               "points (95 %)", "p", "p (Holm)", ""},
              {}};
  for (const OutcomeDifference& d : pair.outcomes) {
    table.rows.push_back({d.name, std::to_string(d.counts.only_baseline),
                          std::to_string(d.counts.only_variant), std::to_string(d.places),
                          std::to_string(d.places_more), std::to_string(d.places_less), points(d.points),
                          p_value(d.test.p), p_holm(d.test), star(d)});
  }
  return table;
}

Table measures_table(const PairComparison& pair) {
  Table table{{"difference", "starts", "mean", "95 %", "median", "differ", "their mean", "matters", "p",
               "p (Holm)", "", "test"},
              {}};
  for (const MeasureDifference& d : pair.measures) {
    table.rows.push_back(
        {with_unit(d.measure), std::to_string(d.trials), signed_number(d.mean.value), range(d.mean.interval),
         signed_number(d.median), std::to_string(d.trials_that_differ), signed_number(d.mean_of_those),
         number(d.smallest), p_value(d.test.p), p_holm(d.test), star(d), d.ranks.exact ? "exact" : "normal"});
  }
  return table;
}

void add_list(const std::vector<std::string>& items, Report& report) {
  if (!items.empty()) report.emplace_back(List{items});
}

std::string explanation(const Comparison& comparison) {
  return fmt::format(
      "Differences are variant less baseline: of {0}. Trials are paired within case and seed by their start. "
      "A place is a start of a case; what begins there, with any seed, counts as one: tests change the sign "
      "of whole places, intervals are of places within cases. Right and wrong: all ways to give signs are "
      "counted. Everything else: Wilcoxon's signed ranks of the mean differences of places; exact up to {1} "
      "that differ, otherwise the normal approximation. It is compared where both are right; mean and median "
      "are of all these starts, \"their mean\" of those that differ. The CPU time of a step is the median "
      "over a trial's steps. A difference below \"matters\" matters to nobody, whatever its p. Holm's "
      "correction in two families: tests of right and wrong ({2}), and others ({3}); tests with fewer than 6 "
      "places that differ could not be significant and are not among them. * marks p (Holm) < {4} of what "
      "matters. Medians of steps, way and errors are of right trials. Intervals are 95 %.",
      comparison.baseline, most_exact_differences, comparison.outcome_tests, comparison.measure_tests,
      significance);
}

}  // namespace

Report first_screen(const Comparison& comparison) {
  Report report;
  report.emplace_back(Heading{heading(comparison)});
  add_list(comparison.warnings, report);
  report.emplace_back(methods_table(comparison));
  for (const PairComparison& pair : comparison.pairs) report.emplace_back(Paragraph{pair.conclusion});
  if (comparison.cases.size() > 1) report.emplace_back(cases_table(comparison));
  return report;
}

Report comparison_report(const Comparison& comparison, const Report& parameters) {
  Report report = first_screen(comparison);
  for (const PairComparison& pair : comparison.pairs) {
    report.emplace_back(Heading{fmt::format("{} against {}", pair.variant, comparison.baseline)});
    add_list(pair.warnings, report);
    report.emplace_back(outcomes_table(pair, comparison.baseline));
    if (!pair.measures.empty()) report.emplace_back(measures_table(pair));
  }
  report.insert(report.end(), parameters.begin(), parameters.end());
  report.emplace_back(Heading{"How to read this"});
  report.emplace_back(Paragraph{explanation(comparison)});
  return report;
}

}  // namespace glocal
