#include "evaluation/results/agreement.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "evaluation/results/summary_text.hpp"

namespace glocal::test::agreement_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// The robot drives along odometry's x axis, which lies at (100, 50) on the map and points to its y axis.
Declaration declared_at(double way, double off_m = 0.0, double off_deg = 0.0, int segment = 0) {
  return {way, segment, Pose2{100.0 + off_m, 50.0 + way, radians(90.0 + off_deg)}, Pose2{way, 0.0, 0.0}};
}

TEST(Agreement, OfPosesThatOdometryCarriesFromOneToTheNext) {
  const Agreement agreement = agreement_of({declared_at(10.0), declared_at(0.0), declared_at(25.0)});
  EXPECT_EQ(agreement.pairs, 2U);
  EXPECT_THAT(agreement.disagree_at_m, IsEmpty());
}

TEST(Agreement, LeavesRoomForTheDriftOfOdometry) {
  // 10 m apart: 0.5 m + 1 m, and 10 deg + 20 deg. A turn of the first moves what it is carried to.
  EXPECT_THAT(agreement_of({declared_at(0.0), declared_at(10.0, 1.49)}).disagree_at_m, IsEmpty());
  EXPECT_THAT(agreement_of({declared_at(0.0), declared_at(10.0, 1.51)}).disagree_at_m, ElementsAre(10.0));
  EXPECT_THAT(agreement_of({declared_at(0.0), declared_at(10.0, 0.0, 29.0)}).disagree_at_m, IsEmpty());
  EXPECT_THAT(agreement_of({declared_at(0.0), declared_at(10.0, 0.0, 31.0)}).disagree_at_m,
              ElementsAre(10.0));
}

TEST(Agreement, IsNotAskedAcrossDrives) {
  const Agreement agreement = agreement_of({declared_at(0.0), declared_at(1.0, 50.0, 0.0, 1)});
  EXPECT_EQ(agreement.pairs, 0U);
  EXPECT_THAT(agreement.disagree_at_m, IsEmpty());
}

nlohmann::ordered_json summary_with(const char* trials) {
  nlohmann::ordered_json summary = nlohmann::ordered_json::parse(R"({"name": "n", "seed": 1, "complete": true,
      "success_rate": {"value": 0.0, "low": 0.0, "high": 0.1}, "after_declaration": {"steps": 0},
      "steps_to_localize": {"median": 1}, "distance_to_localize_m": {"median": 1},
      "translation_error_m": {"median": 1, "max": 1}, "rotation_error_deg": {"median": 1, "max": 1},
      "step_ms": {"median": 1, "p95": 1}, "stage_ms": {"match": {"median": 1}},
      "map": {"build_ms": 1, "index_ms": 1}})");
  summary["trials"] = nlohmann::ordered_json::parse(trials);
  return summary;
}

std::string text_of(const char* trials) {
  return summary_text(summary_with(trials));
}

TEST(Summary, TellsAHalfOfAStep) {
  nlohmann::ordered_json summary = summary_with(R"({"count": 2, "right": 2, "wrong": 0, "undecided": 0})");
  summary["steps_to_localize"]["median"] = 26.5;
  EXPECT_THAT(summary_text(summary), HasSubstr("localized after     26.5 steps, 1.0 m (median)"));
}

TEST(Agreement, IsToldInPlaceOfSuccess) {
  const std::string agree = text_of(R"({"count": 9, "right": 0, "wrong": 0, "undecided": 1,
      "declared_without_reference": 8, "agreement": {"pairs": 7, "disagree_at_m": []}})");
  EXPECT_THAT(agree, HasSubstr("trials              9: 8 declared without reference pose, 1 undecided\n"));
  EXPECT_THAT(agree, HasSubstr("all declared poses agree with each other along the drive"));
  EXPECT_THAT(agree, Not(HasSubstr("success")));
  EXPECT_THAT(text_of(R"({"count": 9, "right": 0, "wrong": 0, "undecided": 0,
      "declared_without_reference": 9, "agreement": {"pairs": 8, "disagree_at_m": [5.0, 7.25]}})"),
              HasSubstr("2 of 9 declared poses disagree with the one before, carried on by odometry: at 5.0, "
                        "7.2 m"));
  EXPECT_THAT(text_of(R"({"count": 2, "right": 1, "wrong": 0, "undecided": 1})"),
              HasSubstr("trials              2: 1 right, 0 wrong, 1 undecided\n  success"));
}

}  // namespace
}  // namespace glocal::test::agreement_test
