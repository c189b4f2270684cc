#include "evaluation/comparison/comparison_report.hpp"

#include <fmt/format.h>

#include <optional>
#include <vector>

#include "evaluation/results/proportions.hpp"

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
std::string p_value(double p) {
  return p < 0.001 ? "<0.001" : fmt::format("{:.3f}", p);
}
std::string with_unit(const Measure& measure) {
  return *measure.unit == '\0' ? measure.label : fmt::format("{}, {}", measure.label, measure.unit);
}
const char* star(double p_holm) {
  return p_holm < significance ? "*" : "";
}

Table runs_table(const Comparison& comparison) {
  Table table{{"run", "right", "%, 95 %", "wrong", "%, 95 %", "undecided"}, {}};
  for (const RunFigures& run : comparison.runs) {
    table.rows.push_back({run.name, std::to_string(run.right), per_cent(run.success),
                          std::to_string(run.wrong), per_cent(run.false_rate),
                          std::to_string(run.undecided)});
  }
  return table;
}

Table medians_table(const Comparison& comparison) {
  Table table{{"median"}, {}};
  for (const Measure& measure : comparison.measured) table.header.push_back(with_unit(measure));
  for (const RunFigures& run : comparison.runs) {
    table.rows.push_back({run.name});
    for (const std::optional<double>& median : run.medians)
      table.rows.back().push_back(median ? number(*median) : "-");
  }
  return table;
}

Table outcomes_table(const PairComparison& pair, const std::string& baseline) {
  Table table{{"outcome", "only " + baseline, "only " + pair.variant, "difference, points", "95 %, bootstrap",
               "95 %, Newcombe", "p", "p (Holm)", ""},
              {}};
  for (const OutcomeDifference& d : pair.outcomes) {
    table.rows.push_back({d.name, std::to_string(d.counts.only_first), std::to_string(d.counts.only_second),
                          signed_number(d.points.value), range(d.points.interval), range(d.newcombe_points),
                          p_value(d.p), p_value(d.p_holm), star(d.p_holm)});
  }
  return table;
}

Table measures_table(const PairComparison& pair) {
  Table table{
      {"difference", "starts", "estimate", "95 %", "matters", "median", "95 %", "p", "p (Holm)", "", "test"},
      {}};
  for (const MeasureDifference& d : pair.measures) {
    table.rows.push_back({with_unit(d.measure), std::to_string(d.starts), signed_number(d.shift.value),
                          range({d.shift.low, d.shift.high}), number(d.smallest),
                          signed_number(d.median.value), range(d.median.interval), p_value(d.test.p),
                          p_value(d.p_holm), d.matters() ? star(d.p_holm) : "",
                          d.test.exact ? "exact" : "normal"});
  }
  return table;
}

void add_list(const std::vector<std::string>& items, Report& report) {
  if (!items.empty()) report.emplace_back(List{items});
}

std::string explanation(const Comparison& comparison) {
  return fmt::format(
      "Differences are variant less {0}, start by start. Success and wrong with Wilson's intervals. Right "
      "and "
      "wrong: McNemar's exact test. Everything else: Wilcoxon's signed-rank test, zeros dropped; exact up to "
      "{1} differences, otherwise the normal approximation with corrections for ties and continuity. The "
      "estimate is what this test is about: that of Hodges and Lehmann, of the starts that differ; the "
      "median "
      "is of all. A difference below \"matters\" matters to nobody, whatever its p. Steps, way and errors "
      "are "
      "compared where both runs are right. The CPU time of a step is the median over a trial's steps. Holm's "
      "correction in two families: the {2} tests of right and wrong, the {3} other ones; * marks p (Holm) < "
      "{4} "
      "of what matters. Bootstrap: percentiles of {5} resamples of the starts.",
      comparison.baseline, most_exact_differences, comparison.outcome_tests, comparison.measure_tests,
      significance, bootstrap_resamples);
}

}  // namespace

Report comparison_report(const Comparison& comparison, const Report& parameters) {
  Report report;
  report.emplace_back(Heading{fmt::format("{} starts that all {} runs have, compared with {}",
                                          comparison.starts, comparison.runs.size(), comparison.baseline)});
  add_list(comparison.warnings, report);
  report.emplace_back(runs_table(comparison));
  report.emplace_back(medians_table(comparison));
  for (const PairComparison& pair : comparison.pairs) {
    report.emplace_back(Heading{fmt::format("{} against {}", pair.variant, comparison.baseline)});
    report.emplace_back(Paragraph{pair.conclusion});
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
