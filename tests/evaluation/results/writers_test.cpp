#include "evaluation/results/writers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "evaluation/results/pose_json.hpp"
#include "evaluation/results/records.hpp"

namespace glocal::test::writers_test {
namespace {

using Json = nlohmann::json;

std::vector<std::string> keys(const Json& json) {
  std::vector<std::string> names;
  for (const auto& [key, value] : json.items()) names.push_back(key);
  return names;
}

/// The one line, parsed.
Json parse_line(const std::string& line) {
  EXPECT_EQ(line.find('\n'), line.size() - 1);
  return Json::parse(line);
}

TEST(StepLine, HasTheKeysOfTheContract) {
  StepRecord record = step_record(3, {1.5, -2.0, 0.25});
  record.reference = Pose2{1.0, -2.0, 0.25};
  record.error = off_by(0.5, 2.0);
  const Json json = parse_line(step_line(7, record));
  EXPECT_THAT(keys(json),
              ::testing::UnorderedElementsAre(
                  "trial", "step", "stamp", "stage_ms", "stage_cpu_ms", "local_map_points", "omega_best",
                  "score_best", "omega_max", "omega_place", "omega_scan", "hits", "proposals",
                  "contact_epsilon_m", "range_noise_m", "points_tested", "hypotheses", "clusters", "best",
                  "verdict", "why", "local_from_robot", "estimate", "reference", "on_map",
                  "translation_error_m", "rotation_error_deg"));
  EXPECT_EQ(json["trial"], 7);
  EXPECT_EQ(json["step"], 3);
  EXPECT_EQ(json["stamp"], 101.5);
  EXPECT_EQ(json["stage_ms"],
            Json::parse(R"({"local_map": 1.0, "match": 2.0, "cluster": 3.0, "rate": 4.0})"));
  EXPECT_EQ(json["stage_cpu_ms"],
            Json::parse(R"({"local_map": 1.5, "match": 2.5, "cluster": 3.5, "rate": 4.5})"));
  EXPECT_EQ(json["contact_epsilon_m"], 0.1);
  EXPECT_EQ(json["range_noise_m"], 0.0125);
  EXPECT_EQ(json["omega_best"], 0.75);
  EXPECT_EQ(json["score_best"], 0.625);
  EXPECT_EQ(json["omega_max"], 0.5);
  EXPECT_EQ(json["omega_place"], 0.875);
  EXPECT_EQ(json["omega_scan"], 0.8125);
  EXPECT_EQ(json["hits"], "mnbu");
  EXPECT_EQ(json["proposals"], 60);
  EXPECT_EQ(json["points_tested"], 700);
  EXPECT_EQ(json["hypotheses"], 4);
  EXPECT_EQ(json["clusters"], 2);
  EXPECT_EQ(json["best"], Json::parse(R"([
      {"pose": {"x": 1.5, "y": -2.0, "theta": 0.25}, "size": 3, "r": 0.6, "r_normalised": 0.75},
      {"pose": {"x": 9.0, "y": 9.0, "theta": 0.0}, "size": 1, "r": 0.2, "r_normalised": 0.25}])"));
  EXPECT_EQ(json["verdict"], "searching");
  EXPECT_EQ(json["why"], "not yet");
  EXPECT_EQ(json["estimate"], Json::parse(R"({"x": 1.5, "y": -2.0, "theta": 0.25})"));
  EXPECT_EQ(json["reference"], Json::parse(R"({"x": 1.0, "y": -2.0, "theta": 0.25})"));
  EXPECT_EQ(json["translation_error_m"], 0.5);
  EXPECT_DOUBLE_EQ(json["rotation_error_deg"].get<double>(), 2.0);
}

TEST(StepLine, HasPosesInSpaceWhereTheMotionIsNotPlanar) {
  const Pose3 pose({1.5, -2.0, 0.75}, exponential({0.3, -0.2, 1.0}));
  StepRecord record = step_record(3, {});
  record.result.motion = Motion::free;
  record.result.clusters[0].map_from_robot = pose;
  record.result.verdict = {VerdictKind::ambiguous, std::nullopt, {pose, Pose3()}, "two"};
  record.reference = Pose3();
  const Json json = parse_line(step_line(7, record));
  for (const Json& written : {json["best"][0]["pose"], json["estimate"], json["candidates"][0]}) {
    EXPECT_EQ(pose_of(written), pose);
    EXPECT_EQ(written["theta"], pose.heading());
  }
  EXPECT_EQ(json["reference"]["qw"], 1.0);
  EXPECT_TRUE(json["local_from_robot"].contains("z"));
}

TEST(TrialLine, HasPosesInSpaceWhereTheMotionIsNotPlanar) {
  TrialRecord trial;
  trial.motion = Motion::upright;
  trial.pose = Pose3({1, 2, 3}, turn_about_z(0.5));
  trial.start_reference = Pose2{4, 5, 0};
  const Json json = parse_line(trial_line(trial));
  EXPECT_EQ(pose_of(json["pose"]), *trial.pose);
  EXPECT_EQ(json["start"]["reference"]["z"], 0.0);
}

TEST(StepLine, TellsWhatTheVerdictRestsOn) {
  StepRecord record = step_record(3, {1.5, -2.0, 0.25});
  record.result.verdict.estimate =
      PoseEstimate{Pose2{1.0, 2.0, 0.5}, 0.875, PoseCovariance{1, 2, 3, 4, 5, 6}};
  record.result.verdict.evidence = {{"margin", 0.25}, {"distance_m", 3.0}};
  record.nees = 2.5;
  const Json json = parse_line(step_line(7, record));
  EXPECT_EQ(json["confidence"], 0.875);
  EXPECT_EQ(json["covariance"], Json::parse("[1, 2, 3, 4, 5, 6]"));
  EXPECT_EQ(json["nees"], 2.5);
  EXPECT_EQ(json["evidence"], Json::parse(R"({"margin": 0.25, "distance_m": 3.0})"));
  EXPECT_EQ(json["estimate"], Json::parse(R"({"x": 1.0, "y": 2.0, "theta": 0.5})"));  // what is believed
}

TEST(StepLine, TellsHowTheRobotIsSetUp) {
  StepRecord record = step_record(3, {1.5, -2.0, 0.25});
  record.result.setup = SetupCheck{.agreement = -7.5, .way_m = 2.0, .is_in_doubt = true};
  EXPECT_EQ(
      parse_line(step_line(7, record))["setup"],
      Json::parse(R"({"agreement": -7.5, "way_m": 2.0, "walls": 0, "stuck_share": 0.0, "in_doubt": true})"));
  record.result.setup = SetupCheck{.mount_angle_deg = 3.0,
                                   .mount_angle_sd_deg = 1.25,
                                   .late_by = 4,
                                   .range_bias_m = -0.25,
                                   .walls = 7,
                                   .stuck_share = 0.125,
                                   .fault = SetupFault::late_scans};
  EXPECT_EQ(parse_line(step_line(7, record))["setup"], Json::parse(R"({
      "agreement": 0.0, "way_m": 0.0, "mount_angle_deg": 3.0, "mount_angle_sd_deg": 1.25, "late_by": 4,
      "range_bias_m": -0.25, "walls": 7, "stuck_share": 0.125, "fault": "late_scans", "in_doubt": false})"));
}

TEST(StepLine, LeavesOutWhatIsNotKnown) {
  StepRecord record = step_record(0, {});
  record.result.clusters.clear();
  record.result.ratings.clear();
  record.result.omega_place.reset();
  record.result.omega_scan.reset();
  record.result.hit_kinds.clear();
  const Json json = parse_line(step_line(0, record));
  for (const char* key : {"estimate", "omega_place", "omega_scan", "hits", "reference", "translation_error_m",
                          "candidates", "setup"}) {
    EXPECT_FALSE(json.contains(key)) << key;
  }
  EXPECT_EQ(json["clusters"], 0);
  EXPECT_EQ(json["best"], Json::array());
}

TEST(StepLine, ListsFiftyClustersButCountsAll) {
  StepRecord record = step_record(0, {});
  record.result.clusters.assign(51, Cluster{{0}, {}});
  record.result.ratings.assign(51, Rating{0.1, 0.2});
  const Json json = parse_line(step_line(0, record));
  EXPECT_EQ(json["clusters"], 51);
  EXPECT_EQ(parse_line(step_line(0, record, 51))["best"].size(), 51U);
  EXPECT_TRUE(parse_line(step_line(0, record, 0))["best"].empty());
  EXPECT_EQ(json["best"].size(), 50U);
}

TEST(StepLine, ListsTheCandidatesOfAnAmbiguousVerdict) {
  StepRecord record = step_record(0, {});
  record.result.verdict = {VerdictKind::ambiguous, std::nullopt, {Pose2{1, 2, 0}, Pose2{3, 4, 0.5}}, "two"};
  const Json json = parse_line(step_line(0, record));
  EXPECT_EQ(json["verdict"], "ambiguous");
  EXPECT_EQ(json["candidates"],
            Json::parse(R"([{"x": 1.0, "y": 2.0, "theta": 0.0}, {"x": 3.0, "y": 4.0, "theta": 0.5}])"));
}

TEST(TrialLine, HasTheKeysOfTheContract) {
  TrialRecord trial;
  trial.trial = 2;
  trial.start_sample = 30;
  trial.start_m = 12.5;
  trial.start_stamp = 99.0;
  trial.start_reference = Pose2{1, 2, 0};
  trial.outcome = Outcome::wrong;
  trial.steps = 5;
  trial.distance_m = 4.5;
  trial.pose = Pose2{7, 8, 0.5};
  trial.error = off_by(3.0, 1.0);
  trial.why = "found \"it\"\n";
  const Json json = parse_line(trial_line(trial));
  EXPECT_THAT(keys(json),
              ::testing::UnorderedElementsAre("trial", "start", "outcome", "steps", "distance_m", "pose",
                                              "translation_error_m", "rotation_error_deg", "why"));
  EXPECT_EQ(json["trial"], 2);
  EXPECT_EQ(json["start"], Json::parse(R"({"sample": 30, "distance_m": 12.5, "stamp": 99.0,
                                           "reference": {"x": 1.0, "y": 2.0, "theta": 0.0}})"));
  EXPECT_EQ(json["outcome"], "wrong");
  EXPECT_EQ(json["steps"], 5);
  EXPECT_EQ(json["distance_m"], 4.5);
  EXPECT_EQ(json["pose"], Json::parse(R"({"x": 7.0, "y": 8.0, "theta": 0.5})"));
  EXPECT_EQ(json["translation_error_m"], 3.0);
  EXPECT_EQ(json["why"], "found \"it\"\n");
}

TEST(TrialLine, AnUndecidedTrialHasNoPose) {
  const Json json = parse_line(trial_line({}));
  EXPECT_EQ(json["outcome"], "undecided");
  EXPECT_FALSE(json.contains("pose"));
  EXPECT_FALSE(json.contains("translation_error_m"));
  EXPECT_FALSE(json["start"].contains("reference"));
}

TEST(Tum, IsOneLineForEachPose) {
  // Headings of 0, 90 and 180 degrees: the quaternion's z and w are sine and cosine of half of them.
  TrialRecord trial;
  for (std::size_t i = 0; i < 3; ++i) {
    trial.records.push_back(step_record(i, {1.0, -2.5, radians(90.0 * static_cast<double>(i))}));
  }
  trial.records[1].result.clusters.clear();
  trial.records[1].reference = Pose2{0.125, 3.0, radians(90.0)};
  const Trajectories tum = tum_trajectories(trial);
  EXPECT_EQ(tum.estimate,
            "100.000000 1.000000 -2.500000 0 0 0 0.000000000 1.000000000\n"
            "101.000000 1.000000 -2.500000 0 0 0 1.000000000 0.000000000\n");
  EXPECT_EQ(tum.localized, "") << "no pose was declared";
  EXPECT_EQ(tum.reference, "100.500000 0.125000 3.000000 0 0 0 0.707106781 0.707106781\n");
}

TEST(Tum, OfDeclaredPosesHasNoOthers) {
  TrialRecord trial;
  for (std::size_t i = 0; i < 3; ++i) trial.records.push_back(step_record(i, {1.0, 2.0, 0.0}));
  Verdict& verdict = trial.records[1].result.verdict;
  verdict.kind = VerdictKind::localized;
  verdict.map_from_robot = Pose2{4.0, 5.0, radians(180.0)};
  EXPECT_EQ(tum_trajectories(trial).localized,
            "100.500000 4.000000 5.000000 0 0 0 1.000000000 0.000000000\n");
}

}  // namespace
}  // namespace glocal::test::writers_test
