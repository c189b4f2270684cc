#include "report/step_columns.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "evaluation/results/records.hpp"
#include "evaluation/results/writers.hpp"
#include "files.hpp"
#include "report/numbers.hpp"

namespace glocal::test::step_columns_test {
namespace {

using Json = nlohmann::ordered_json;
using testing::HasSubstr;

Json line_of(const StepRecord& record) {
  return Json::parse(step_line(0, record));
}

Json columns_of(const std::vector<StepRecord>& records, std::size_t clusters = 50) {
  StepColumns columns(clusters);
  for (const StepRecord& record : records) columns.add(line_of(record));
  return columns.to_json();
}

/// What is said of a line.
std::string fault(const Json& line) {
  return error_of<std::exception>([&] { StepColumns(50).add(line); });
}

TEST(Rounded, IsTheNearestMultipleAndNullForWhatIsNone) {
  EXPECT_EQ(rounded(12.34567, 1e3).dump(), "12.346");
  EXPECT_EQ(rounded(-0.30000000000000004, 1e4).dump(), "-0.3");
  EXPECT_EQ(rounded(7.0001, 1e3).dump(), "7");
  EXPECT_TRUE(rounded(std::numeric_limits<double>::infinity(), 1e3).is_null());
}

TEST(ShortNumbers, AreAllButThoseOfAKey) {
  const Json json = {{"stamp", 1.23456789123},
                     {"at", {{"x", 1.23456789123}, {"stamp", 2.3456789123}}},
                     {"n", {1, 0.1234567891, "0.1234567891"}}};
  EXPECT_EQ(with_short_numbers(json, "stamp"), Json::parse(R"({"stamp": 1.23456789123,
    "at": {"x": 1.234568, "stamp": 2.3456789123}, "n": [1, 0.1234568, "0.1234567891"]})"));
}

TEST(ShortNumbers, KeepMillimetresFarAway) {
  EXPECT_EQ(with_short_numbers(Json{4649776.12345, -12345.67891, 9999.87654}, "").dump(),
            "[4649776.123,-12345.679,9999.877]");
}

TEST(ShortNumber, HasSevenDigitsAndNoPointWhereItIsWhole) {
  EXPECT_EQ(short_number(0.30000000000000004).dump(), "0.3");
  EXPECT_EQ(short_number(-17.956381234).dump(), "-17.95638");
  EXPECT_EQ(short_number(1234567.89).dump(), "1234568.0");
  EXPECT_EQ(short_number(1.23456789e-9).dump(), "1.234568e-09");
  EXPECT_EQ(short_number(88.0).dump(), "88");
  EXPECT_EQ(short_number(-0.0).dump(), "0");
  EXPECT_EQ(short_number(1e300).dump(), "1e+300");
  EXPECT_EQ(short_number(-17.956381234, 3).dump(), "-18.0");
}

TEST(StepColumns, HaveAValueForEachStep) {
  StepRecord first = step_record(0, {1.5, -2.0, 1.0 / 3.0});
  first.reference = Pose2{1.0, -2.0, 0.25};
  first.error = off_by(0.5, 2.0);
  StepRecord second = step_record(1, {1, 2, 3});
  second.result.omega_place = std::nullopt;
  second.result.clusters.clear();
  second.result.ratings.clear();
  second.result.verdict = {VerdictKind::ambiguous, std::nullopt, {Pose2{1, 2, 3}, Pose2{4, 5, 0.5}}, "two"};
  StepRecord third = step_record(2, {1, 2, 3});
  third.result.verdict.estimate = PoseEstimate{Pose2{7, 8, 0.5}, 0.75};
  EXPECT_EQ(columns_of({first, second, third}), Json::parse(R"({
    "step": [0, 1, 2], "step_ms": [10, 10, 10], "match_ms": [2, 2, 2],
    "local_map_points": [40, 40, 40], "omega_best": [0.75, 0.75, 0.75], "score_best": [0.625, 0.625, 0.625],
    "omega_max": [0.5, 0.5, 0.5],
    "proposals": [60, 60, 60], "hypotheses": [4, 4, 4], "clusters": [2, 0, 2],
    "omega_place": [0.875, null, 0.875],
    "translation_error_m": [0.5, null, null], "rotation_error_deg": [2, null, null], "confidence": [null, null, 0.75],
    "contact_epsilon_m": [0.1, 0.1, 0.1], "range_noise_m": [0.0125, 0.0125, 0.0125],
    "verdict": ["searching", "ambiguous", "searching"], "why": [0, 1, 0],
    "hits": ["mnbu", "mnbu", "mnbu"],
    "estimate": {"x": [1.5, null, 7], "y": [-2, null, 8], "theta": [0.3333, null, 0.5]},
    "reference": {"x": [1, null, null], "y": [-2, null, null], "theta": [0.25, null, null]},
    "local_from_robot": {"x": [1, 1, 1], "y": [2, 2, 2], "theta": [0.5, 0.5, 0.5]},
    "candidates": [[], [1, 2, 3, 4, 5, 0.5], []],
    "evidence": {},
    "best": {"first": [0, 2, 2, 4], "x": [1.5, 9, 1, 9], "y": [-2, 9, 2, 9], "theta": [0.3333, 0, 3, 0],
             "size": [3, 1, 3, 1], "r": [0.6, 0.2, 0.6, 0.2], "r_normalised": [0.75, 0.25, 0.75, 0.25]},
    "sentences": ["not yet", "two"]})"));
}

TEST(StepColumns, HaveHeightsAndRotationsInSpace) {
  const Pose3 tilted{{1.0, 2.0, 3.0}, {0.8, 0.6, 0.0, 0.0}};
  StepRecord record = step_record(0, {});
  record.result.motion = Motion::upright;
  record.result.clusters[0].map_from_robot = tilted;
  record.result.verdict.candidates = {tilted, Pose2{4.0, 5.0, 0.0}};
  record.reference = tilted;
  const Json columns = columns_of({record}, 1);
  EXPECT_EQ(columns["reference"], Json::parse(R"({"x": [1], "y": [2], "theta": [0], "z": [3], "qx": [0.6],
                                                  "qy": [0], "qz": [0], "qw": [0.8]})"));
  EXPECT_EQ(columns["candidates_in_space"], Json::parse("[[3, 0.6, 0, 0, 0.8, 0, 0, 0, 0, 1]]"));
  EXPECT_EQ(columns["best"]["z"], Json::parse("[3]"));
  EXPECT_EQ(columns["best"]["qx"], Json::parse("[0.6]"));
}

TEST(StepColumns, HaveClustersFarAwayToTheMillimetre) {
  StepRecord record = step_record(0, {});
  record.result.clusters[0].map_from_robot = Pose2{500'000.1234, 4'649'776.4321, 0.0};
  const Json columns = columns_of({record}, 1);
  EXPECT_EQ(columns["best"]["x"].dump(), "[500000.123]");
  EXPECT_EQ(columns["best"]["y"].dump(), "[4649776.432]");
}

TEST(StepColumns, HaveTheVerificationsOfTheStepsThatWereVerified) {
  StepRecord verified = step_record(1, {1, 2, 0});
  Verification verification;
  verification.score = 0.5;
  verification.margin = 0.25;
  verification.is_refuted = true;
  verification.certificate = Certificate{.contact = 0.75, .at_most = 0.5};
  verified.result.verification = verification;
  const Json verifications = columns_of({step_record(0, {}), verified})["verifications"];
  ASSERT_EQ(verifications.size(), 1U);
  EXPECT_EQ(verifications[0]["step"], 1);
  EXPECT_EQ(verifications[0]["refuted"], true);
  EXPECT_EQ(verifications[0]["certificate"]["contact"], 0.75);
  EXPECT_EQ(verifications[0]["certificate"]["at_most"], 0.5);
  EXPECT_FALSE(columns_of({step_record(0, {})}).contains("verifications"));
}

TEST(StepColumns, OfNoStepsAreEmpty) {
  const Json columns = columns_of({});
  EXPECT_EQ(columns["step"], Json::array());
  EXPECT_EQ(columns["estimate"]["x"], Json::array());
  EXPECT_EQ(columns["best"]["first"], Json::parse("[0]"));
  EXPECT_EQ(columns["evidence"], Json::object());
}

TEST(StepColumns, HaveAColumnForEachNumberThatAVerdictEverRestsOn) {
  std::vector<StepRecord> records;
  for (std::size_t i = 0; i < 4; ++i) records.push_back(step_record(i, {}));
  records[1].result.verdict.evidence = {{"margin", 0.25}};
  records[2].result.verdict.evidence = {{"margin", 0.5}, {"steps", 3.0}};
  EXPECT_EQ(columns_of(records)["evidence"],
            Json::parse(R"({"margin": [null, 0.25, 0.5, null], "steps": [null, null, 3, null]})"));
}

TEST(StepColumns, KeepTheBestClusters) {
  const std::vector<StepRecord> records = {step_record(0, {5, 6, 0}), step_record(1, {7, 8, 0})};
  const Json one = columns_of(records, 1)["best"];
  EXPECT_EQ(one["first"], Json::parse("[0, 1, 2]"));
  EXPECT_EQ(one["x"], Json::parse("[5, 7]"));
  const Json none = columns_of(records, 0)["best"];
  EXPECT_EQ(none["first"], Json::parse("[0, 0, 0]"));
  EXPECT_EQ(none["r"], Json::array());
}

TEST(StepColumns, TakeWhatJsonHasInsteadOfInfinity) {
  StepRecord record = step_record(0, {});
  record.result.omega_best = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(columns_of({record})["omega_best"], Json::parse("[null]"));
}

TEST(StepColumns, WantOneStepAfterTheOther) {
  StepColumns columns(50);
  columns.add(line_of(step_record(0, {})));
  for (const std::size_t wrong : {0U, 2U}) {
    EXPECT_THAT(error_of<std::invalid_argument>([&] { columns.add(line_of(step_record(wrong, {}))); }),
                HasSubstr("of trial 0 is here, where step 1 belongs"))
        << wrong;
  }
  EXPECT_EQ(columns.size(), 1U);
  EXPECT_THAT(columns.step_ms(), testing::ElementsAre(10.0F));
}

TEST(StepColumns, WantWhatEachLineHas) {
  const Json whole = line_of(step_record(0, {}));
  EXPECT_EQ(fault(whole), "");
  for (const char* key :
       {"step", "stage_ms", "local_map_points", "omega_best", "score_best", "omega_max", "proposals",
        "hypotheses", "clusters", "best", "verdict", "why", "local_from_robot"}) {
    Json line = whole;
    line[key] = "text";
    const bool may_be_text = key == std::string("verdict") || key == std::string("why");
    EXPECT_EQ(fault(line).empty(), may_be_text) << key;
    if (key == std::string("local_from_robot")) continue;
    line.erase(key);
    EXPECT_THAT(fault(line), HasSubstr(key));
  }
  EXPECT_NE(fault("text"), "");
  EXPECT_NE(fault({}), "");
}

}  // namespace
}  // namespace glocal::test::step_columns_test
