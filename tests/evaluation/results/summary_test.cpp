#include "evaluation/results/summary.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "evaluation/results/records.hpp"

namespace glocal::test::summary_test {
namespace {

using Json = nlohmann::json;

TrialRecord trial(Outcome outcome, std::size_t steps, double distance_m, const PoseError& error) {
  TrialRecord record;
  record.outcome = outcome;
  record.steps = steps;
  record.distance_m = distance_m;
  if (outcome != Outcome::undecided) record.pose = record.odom_from_robot = Pose2{};
  if (outcome == Outcome::right || outcome == Outcome::wrong) record.error = error;
  return record;
}

Json sum_up(const std::vector<TrialRecord>& trials, bool complete = true) {
  Summary summary;
  for (const TrialRecord& record : trials) summary.add(figures_of(record));
  return summary.to_json(
      {{"name", "a name"}, {"seed", 42}, {"map", {{"points", 1000}}}, {"peak_rss_mb", 40.5}}, complete);
}

void expect_spread(const Json& json, double median, double p95, double max) {
  EXPECT_NEAR(json.at("median").get<double>(), median, 1e-9);
  EXPECT_NEAR(json.at("p95").get<double>(), p95, 1e-9);
  EXPECT_NEAR(json.at("max").get<double>(), max, 1e-9);
}

TEST(Summary, CountsOutcomesAndSpreadsOfTheRightOnes) {
  const Json json = sum_up(
      {trial(Outcome::right, 10, 2.0, off_by(0.1, 1.0)), trial(Outcome::right, 20, 4.0, off_by(0.3, 3.0)),
       trial(Outcome::right, 40, 9.0, off_by(0.2, 2.0)), trial(Outcome::wrong, 5, 1.0, off_by(8.0, 90.0)),
       trial(Outcome::undecided, 60, 15.0, {})});
  EXPECT_EQ(json["name"], "a name");
  EXPECT_EQ(json["seed"], 42);
  EXPECT_EQ(json["complete"], true);
  EXPECT_EQ(json["trials"], Json::parse(R"({"count": 5, "right": 3, "wrong": 1, "undecided": 1})"));
  EXPECT_DOUBLE_EQ(json["success_rate"]["value"].get<double>(), 0.6);
  EXPECT_DOUBLE_EQ(json["false_rate"]["value"].get<double>(), 0.2);
  // Wilson's interval for 3 of 5: (3 + z^2/2 -+ z sqrt(6/5 + z^2/4)) / (5 + z^2) with z^2 = 3.841459.
  EXPECT_NEAR(json["success_rate"]["low"].get<double>(), 0.230724, 1e-5);
  EXPECT_NEAR(json["success_rate"]["high"].get<double>(), 0.882379, 1e-5);
  // Three sorted values: the 90 % quantile is 80 % of the way from the second to the third, the 95 % one 90
  // %.
  EXPECT_DOUBLE_EQ(json["steps_to_localize"]["median"].get<double>(), 20.0);
  EXPECT_DOUBLE_EQ(json["steps_to_localize"]["p90"].get<double>(), 36.0);
  EXPECT_DOUBLE_EQ(json["distance_to_localize_m"]["median"].get<double>(), 4.0);
  EXPECT_DOUBLE_EQ(json["distance_to_localize_m"]["p90"].get<double>(), 8.0);
  expect_spread(json["translation_error_m"], 0.2, 0.29, 0.3);
  expect_spread(json["rotation_error_deg"], 2.0, 2.9, 3.0);
  EXPECT_EQ(json["map"]["points"], 1000);
  EXPECT_EQ(json["peak_rss_mb"], 40.5);
}

TEST(Summary, TimesAreOfAllStepsOfAllTrials) {
  TrialRecord first = trial(Outcome::undecided, 2, 1.0, {});
  first.records = {step_record(0, {}), step_record(1, {})};
  TrialRecord second = trial(Outcome::undecided, 1, 0.0, {});
  second.records = {step_record(0, {})};
  second.records[0].result.stage_ms = {10.0, 20.0, 30.0, 40.0, 0.0, 100.0};
  const Json json = sum_up({first, second});
  EXPECT_EQ(json["steps"], 3);
  expect_spread(json["step_ms"], 10.0, 181.0, 200.0);
  expect_spread(json["answer_ms"], 10.0, 91.0, 100.0);
  EXPECT_DOUBLE_EQ(json["answer_ms"]["p99"].get<double>(), 98.2);
  expect_spread(json["stage_ms"]["local_map"], 1.0, 9.1, 10.0);
  expect_spread(json["stage_ms"]["match"], 2.0, 18.2, 20.0);
  expect_spread(json["stage_ms"]["cluster"], 3.0, 27.3, 30.0);
  expect_spread(json["stage_ms"]["rate"], 4.0, 36.4, 40.0);
}

TEST(Summary, ErrorsAfterTheDeclarationAreThoseOfLocalizedStepsOnTheMap) {
  TrialRecord record = trial(Outcome::right, 2, 1.0, off_by(0.1, 1.0));
  // Step 0 is before the declaration; step 3 is off the map, step 4 is not localized; step 6 has no error.
  const std::vector<double> errors = {9.0, 0.1, 0.2, 9.0, 9.0, 0.4, 0.0};
  for (std::size_t i = 0; i < errors.size(); ++i) {
    record.records.push_back(step_record(i, {}));
    record.records[i].error = off_by(errors[i], 10.0 * errors[i]);
    record.records[i].result.verdict.kind = i == 0 ? VerdictKind::searching : VerdictKind::localized;
  }
  record.records[3].on_map = false;
  record.records[4].result.verdict.kind = VerdictKind::unknown_place;
  record.records[6].error.reset();
  const Json json = sum_up({record});
  EXPECT_EQ(json["after_declaration"]["steps"], 3);
  expect_spread(json["after_declaration"]["translation_error_m"], 0.2, 0.38, 0.4);
  expect_spread(json["after_declaration"]["rotation_error_deg"], 2.0, 3.8, 4.0);
}

TEST(Summary, DeclarationsWithoutReferenceAreCountedApart) {
  const Json json = sum_up({trial(Outcome::declared, 3, 1.0, {})});
  EXPECT_EQ(json["trials"], Json::parse(R"({"count": 1, "right": 0, "wrong": 0, "undecided": 0,
                            "declared_without_reference": 1, "agreement": {"pairs": 0, "disagree_at_m": []}})"));
}

TEST(Summary, OfNoTrialsHasAllKeysOfTheContract) {
  const Json json = sum_up({}, false);
  EXPECT_EQ(json["complete"], false);
  EXPECT_EQ(json["trials"]["count"], 0);
  for (const char* key :
       {"success_rate", "false_rate", "steps_to_localize", "distance_to_localize_m", "translation_error_m",
        "rotation_error_deg", "step_ms", "stage_ms", "map", "peak_rss_mb"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  EXPECT_EQ(json["success_rate"], Json::parse(R"({"value": 0.0, "low": 0.0, "high": 1.0})"));
  expect_spread(json["step_ms"], 0.0, 0.0, 0.0);
}

}  // namespace
}  // namespace glocal::test::summary_test
