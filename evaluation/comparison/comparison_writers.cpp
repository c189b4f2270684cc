#include "evaluation/comparison/comparison_writers.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "evaluation/results/proportions.hpp"

namespace glocal {
namespace {

using Json = nlohmann::ordered_json;

const char* test_name(const SignedRank& test) {
  return test.exact ? "wilcoxon_exact" : "wilcoxon_normal";
}
constexpr const char* outcome_test_name = "mcnemar_exact";

Json value_and_range(double value, double low, double high) {
  return {{"value", value}, {"low", low}, {"high", high}};
}

Json to_json(const Difference& d) {
  return value_and_range(d.value, d.interval.low, d.interval.high);
}

Json to_json(const RunFigures& run, std::span<const Measure> measured) {
  Json medians = Json::object();
  for (std::size_t i = 0; i < measured.size(); ++i) {
    if (run.medians[i]) medians[measured[i].name] = *run.medians[i];
  }
  return {{"name", run.name},
          {"folder", run.folder},
          {"experiment", run.experiment},
          {"seed", run.seed},
          {"right", run.right},
          {"wrong", run.wrong},
          {"undecided", run.undecided},
          {"success_rate", to_json(run.success)},
          {"false_rate", to_json(run.false_rate)},
          {"medians", std::move(medians)}};
}

Json to_json(const OutcomeDifference& d) {
  return {{"outcome", d.name},
          {"both", d.counts.both},
          {"only_baseline", d.counts.only_first},
          {"only_variant", d.counts.only_second},
          {"neither", d.counts.neither},
          {"difference_points", to_json(d.points)},
          {"newcombe_points", {{"low", d.newcombe_points.low}, {"high", d.newcombe_points.high}}},
          {"test", outcome_test_name},
          {"p", d.p},
          {"p_holm", d.p_holm},
          {"significant", d.p_holm < significance}};
}

Json to_json(const MeasureDifference& d) {
  return {{"measure", d.measure.name},
          {"starts", d.starts},
          {"baseline_median", d.baseline_median},
          {"variant_median", d.variant_median},
          {"estimate", value_and_range(d.shift.value, d.shift.low, d.shift.high)},
          {"smallest_that_matters", d.smallest},
          {"median_difference", to_json(d.median)},
          {"mean_difference", to_json(d.mean)},
          {"test", test_name(d.test)},
          {"nonzero", d.test.nonzero},
          {"positive_rank_sum", d.test.positive_sum},
          {"p", d.test.p},
          {"p_holm", d.p_holm},
          {"significant", d.p_holm < significance},
          {"matters", d.matters()}};
}

Json to_json(const PairComparison& pair);

template <class Item>
Json list_of(const std::vector<Item>& items) {
  Json list = Json::array();
  for (const Item& item : items) list.push_back(to_json(item));
  return list;
}

Json to_json(const PairComparison& pair) {
  return {{"variant", pair.variant},
          {"conclusion", pair.conclusion},
          {"warnings", pair.warnings},
          {"outcomes", list_of(pair.outcomes)},
          {"measures", list_of(pair.measures)}};
}

/// A name in quotation marks where it needs them (RFC 4180).
std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + "\"";
}

std::string csv_row(const OutcomeDifference& d) {
  const PairedCounts& n = d.counts;
  const std::size_t starts = n.both + n.only_first + n.only_second + n.neither;
  return fmt::format("{},{},{},{},{},{},{},,,,{},{},{},{},{},{},{}", d.name, starts, n.both + n.only_first,
                     n.both + n.only_second, d.points.value, d.points.interval.low, d.points.interval.high,
                     d.newcombe_points.low, d.newcombe_points.high, outcome_test_name,
                     n.only_first + n.only_second, d.p, d.p_holm, d.p_holm < significance) +
         ",,,,";
}

std::string csv_row(const MeasureDifference& d) {
  return fmt::format("{},{},{},{},{},{},{},{},{},{},,,{},{},{},{},{}", d.measure.name, d.starts,
                     d.baseline_median, d.variant_median, d.median.value, d.median.interval.low,
                     d.median.interval.high, d.mean.value, d.mean.interval.low, d.mean.interval.high,
                     test_name(d.test), d.test.nonzero, d.test.p, d.p_holm, d.p_holm < significance) +
         fmt::format(",{},{},{},{}", d.shift.value, d.shift.low, d.shift.high, d.matters());
}

}  // namespace

Json to_json(const Comparison& comparison) {
  Json runs = Json::array();
  for (const RunFigures& run : comparison.runs) runs.push_back(to_json(run, comparison.measured));
  return {{"baseline", comparison.baseline},
          {"starts", comparison.starts},
          {"significance", significance},
          {"families", {{"outcomes", comparison.outcome_tests}, {"measures", comparison.measure_tests}}},
          {"bootstrap_resamples", bootstrap_resamples},
          {"warnings", comparison.warnings},
          {"runs", std::move(runs)},
          {"pairs", list_of(comparison.pairs)}};
}

std::string to_csv(const Comparison& comparison) {
  std::string text =
      "variant,baseline,measure,starts,baseline_value,variant_value,difference,low,high,mean_difference,"
      "mean_low,mean_high,newcombe_low,newcombe_high,test,differing,p,p_holm,significant,estimate,estimate_"
      "low,"
      "estimate_high,matters\n";
  for (const PairComparison& pair : comparison.pairs) {
    const std::string names = csv_text(pair.variant) + "," + csv_text(comparison.baseline) + ",";
    for (const OutcomeDifference& d : pair.outcomes) text += names + csv_row(d) + "\n";
    for (const MeasureDifference& d : pair.measures) text += names + csv_row(d) + "\n";
  }
  return text;
}

}  // namespace glocal
