#include "evaluation/comparison/comparison_writers.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "evaluation/results/proportions.hpp"

namespace glocal {
namespace {

using Json = nlohmann::ordered_json;

const char* test_name(const SignedRank& ranks) {
  return ranks.exact ? "wilcoxon_exact" : "wilcoxon_normal";
}
constexpr const char* outcome_test_name = "sign_flips_exact";

Json to_json(const Difference& d) {
  return {{"value", d.value}, {"low", d.interval.low}, {"high", d.interval.high}};
}

void add(const OutcomeCounts& counts, Json& json) {
  json.update({{"right", counts.right}, {"wrong", counts.wrong}, {"undecided", counts.undecided}});
}

void add(const TestResult& test, Json& json) {
  json.update({{"differing_places", test.differing},
               {"p", test.p},
               {"has_chance", test.has_chance()},
               {"p_holm", test.p_holm},
               {"significant", test.is_significant()}});
}

Json to_json(const CaseFigures& figures, const std::string& name) {
  Json json = {{"case", name}};
  add(figures.outcomes, json);
  if (figures.median_steps) json["median_steps"] = *figures.median_steps;
  if (figures.right_points) json["right_points"] = to_json(*figures.right_points);
  if (figures.wrong_points) json["wrong_points"] = to_json(*figures.wrong_points);
  return json;
}

Json to_json(const MethodFigures& method, const Comparison& comparison) {
  Json json = {{"name", method.name}, {"experiment", method.experiment}, {"folders", method.folders}};
  add(method.outcomes, json);
  json["success_rate"] = to_json(method.success);
  json["false_rate"] = to_json(method.false_rate);
  json["undecided_rate"] = to_json(method.undecided_rate);
  json["medians"] = Json::object();
  for (std::size_t i = 0; i < comparison.measured.size(); ++i) {
    if (method.medians[i]) json["medians"][comparison.measured[i].name] = *method.medians[i];
  }
  json["cases"] = Json::array();
  for (std::size_t c = 0; c < comparison.cases.size(); ++c)
    json["cases"].push_back(to_json(method.cases[c], comparison.cases[c]));
  return json;
}

Json to_json(const OutcomeDifference& d) {
  Json json = {{"outcome", d.name},
               {"both", d.counts.both},
               {"only_baseline", d.counts.only_baseline},
               {"only_variant", d.counts.only_variant},
               {"neither", d.counts.neither},
               {"places", d.places},
               {"places_more", d.places_more},
               {"places_less", d.places_less},
               {"difference_points", to_json(d.points)},
               {"smallest_that_matters", d.smallest},
               {"matters", d.matters()},
               {"places_needed", d.places_needed},
               {"test", outcome_test_name}};
  add(d.test, json);
  return json;
}

Json to_json(const MeasureDifference& d) {
  Json json = {{"measure", d.measure.name},
               {"starts", d.trials},
               {"places", d.places},
               {"baseline_median", d.baseline_median},
               {"variant_median", d.variant_median},
               {"mean_difference", to_json(d.mean)},
               {"median_difference", d.median},
               {"differing_starts", d.trials_that_differ},
               {"mean_of_differing", d.mean_of_those},
               {"smallest_that_matters", d.smallest},
               {"matters", d.matters()},
               {"places_needed", d.places_needed},
               {"test", test_name(d.ranks)},
               {"positive_rank_sum", d.ranks.positive_sum}};
  add(d.test, json);
  return json;
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

std::string csv_cells(const TestResult& test) {
  return fmt::format("{},{},{},{}", test.differing, test.p, test.p_holm, test.is_significant());
}

std::string csv_row(const OutcomeDifference& d) {
  const PairedCounts& n = d.counts;
  const std::size_t starts = n.both + n.only_baseline + n.only_variant + n.neither;
  return fmt::format("{},{},{},{},{},{},{},{},,{},{},{}", d.name, starts, d.places, n.both + n.only_baseline,
                     n.both + n.only_variant, d.points.value, d.points.interval.low, d.points.interval.high,
                     outcome_test_name, csv_cells(d.test), d.matters());
}

std::string csv_row(const MeasureDifference& d) {
  return fmt::format("{},{},{},{},{},{},{},{},{},{},{},{}", d.measure.name, d.trials, d.places,
                     d.baseline_median, d.variant_median, d.mean.value, d.mean.interval.low,
                     d.mean.interval.high, d.median, test_name(d.ranks), csv_cells(d.test), d.matters());
}

}  // namespace

Json to_json(const Comparison& comparison) {
  Json methods = Json::array();
  for (const MethodFigures& method : comparison.methods) methods.push_back(to_json(method, comparison));
  return {{"baseline", comparison.baseline},
          {"starts", comparison.starts},
          {"places", comparison.places},
          {"cases", comparison.cases},
          {"seeds", comparison.seeds},
          {"significance", significance},
          {"families", {{"outcomes", comparison.outcome_tests}, {"measures", comparison.measure_tests}}},
          {"warnings", comparison.warnings},
          {"methods", std::move(methods)},
          {"pairs", list_of(comparison.pairs)}};
}

std::string to_csv(const Comparison& comparison) {
  std::string text =
      "variant,baseline,measure,starts,places,baseline_value,variant_value,difference,low,high,"
      "median_difference,test,differing,p,p_holm,significant,matters\n";
  for (const PairComparison& pair : comparison.pairs) {
    const std::string names = csv_text(pair.variant) + "," + csv_text(comparison.baseline) + ",";
    for (const OutcomeDifference& d : pair.outcomes) text += names + csv_row(d) + "\n";
    for (const MeasureDifference& d : pair.measures) text += names + csv_row(d) + "\n";
  }
  return text;
}

}  // namespace glocal
