// glocal live, with a recording in place of a robot.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <httplib.h>
// A macro of <resolv.h>, which httplib brings, and a name of Eigen's.
#undef _res

#include <algorithm>
#include <filesystem>
#include <set>

#include "app/room.hpp"
#include "sources/bags/message_writer.hpp"
#include "sources/bags/messages.hpp"
#include "sources/carmen/carmen_parser.hpp"

namespace glocal::test::live_test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// A simulated room: a map, and a drive as a recording.
class Live : public CommandLine {
 protected:
  Live() {
    simulate_room();
    bags::RobotRecording recording;
    for (const carmen::CarmenScan& scan : carmen::read_carmen_log(file("room/drive.log")))
      add(recording, scan, static_cast<std::int64_t>(scan.stamp * 1e9));
    folder_.write("drive.mcap", recording.bytes());
  }

  /// What a robot sends where this scan was made.
  static void add(bags::RobotRecording& recording, const carmen::CarmenScan& scan, std::int64_t stamp_ns) {
    recording.transform("odom", "base_link", stamp_ns, scan.odom_from_robot);
    recording.transform("base_link", "laser", stamp_ns, {}, "/tf_static");
    recording.scan("/scan", stamp_ns,
                   {.angle_min = static_cast<float>(scan.start_angle),
                    .angle_increment = static_cast<float>(scan.angle_step),
                    .range_max = static_cast<float>(scan.max_range),
                    .ranges = scan.ranges});
  }

  [[nodiscard]] Answer live(const std::string& recording, const std::string& options) const {
    return run("live " + file("room/map.yaml") + " --recording " + file(recording) + " --force " + options);
  }
  /// All that `localize` finds, but for times.
  [[nodiscard]] std::vector<Json> steps_of_localize(const std::string& recording) const {
    good(run("localize " + file("room/map.yaml") + " " + file(recording) +
             " --scans /scan --whole --force --out " + file("whole")));
    return comparable(file("whole/steps.jsonl"));
  }
  /// The first step in which they differ is told.
  static void expect_same(const std::vector<Json>& steps, const std::vector<Json>& expected) {
    ASSERT_EQ(steps.size(), expected.size());
    for (std::size_t i = 0; i < steps.size(); ++i) {
      for (const auto& [key, value] : expected[i].items())
        ASSERT_EQ(steps[i].value(key, Json()), value) << i << key;
    }
  }
  static std::vector<Json> comparable(const std::string& lines) {
    std::vector<Json> steps = json_lines(lines);
    for (Json& step : steps) step = without_times(step);
    return steps;
  }
};

TEST_F(Live, FindsWhatLocalizeFindsOnTheRecording) {
  const Answer answer = good(live("drive.mcap", "--out live"));
  EXPECT_THAT(answer.out, HasSubstr("localized"));
  EXPECT_THAT(answer.out, HasSubstr("1 declarations"));
  const std::vector<Json> steps = comparable("live.steps.jsonl");
  EXPECT_GT(steps.size(), 10U);
  expect_same(steps, steps_of_localize("drive.mcap"));
}

TEST_F(Live, AVerificationInPiecesGoesOnBetweenSteps) {
  const std::string pieces = " --set localizer.looks_per_step=500";
  good(live("drive.mcap", "--out live" + pieces));
  EXPECT_THAT(content("live.yaml"),
              testing::EndsWith("\n# Not in here, but changed on the command line:" + pieces + "\n"));
  std::vector<Json> steps = comparable("live.steps.jsonl");
  const auto waits = [](const Json& step) {
    return step.contains("verification") && step["verification"].contains("goes_on");
  };
  EXPECT_EQ(std::erase_if(steps, waits), 1);
  expect_same(steps, steps_of_localize("drive.mcap"));
}

TEST_F(Live, StepsAreBoundedWhereARobotDrivesOnMeanwhile) {
  const auto experiment = [&](const std::string& options) {
    const Answer answer = live("drive.mcap", options + " --set localizer.none=1 --out live");
    EXPECT_THAT(answer.err, HasSubstr("localizer.none"));
    return content("live.yaml");
  };
  EXPECT_THAT(experiment(""), HasSubstr("looks_per_step: 0\n")) << "a recording waits";
  folder_.write("own.yaml", "localizer: {verifier: whole_map}\n");
  EXPECT_THAT(experiment("--real-time --method own.yaml"), HasSubstr("looks_per_step: 3000000\n"));
  folder_.write("own.yaml", "localizer: {verifier: whole_map, looks_per_step: 7}\n");
  EXPECT_THAT(experiment("--real-time --method own.yaml"), HasSubstr("looks_per_step: 7\n"));
}

TEST_F(Live, GoesOnThoughStepsCannotBeWrittenButDoesNotBeginSo) {
  std::filesystem::create_symlink("/dev/full", "live.steps.jsonl");
  const Answer full = good(live("drive.mcap", "--out live"));
  EXPECT_THAT(full.err, HasSubstr("live.steps.jsonl: cannot write: No space left on device; steps are not"));
  EXPECT_THAT(full.out, HasSubstr("1 declarations"));
  std::filesystem::create_directory("other.steps.jsonl");
  EXPECT_THAT(refusal(live("drive.mcap", "--out other"), 1),
              HasSubstr("other.steps.jsonl: cannot write: Is a directory"));
  // The steps of another run are kept, though its experiment is gone.
  folder_.write("earlier.steps.jsonl", "{}\n");
  EXPECT_THAT(refusal(run("live room/map.yaml --recording drive.mcap --out earlier")),
              HasSubstr("earlier.steps.jsonl: error: the file exists"));
  EXPECT_FALSE(std::filesystem::exists("earlier.yaml"));
}

TEST_F(Live, GoesOnThoughItsPoseCannotBeKeptButDoesNotBeginSo) {
  // A name that is written under a longer one first.
  const std::string name(250, 's');
  const Answer long_name = good(live("drive.mcap", "--out live --state " + name));
  EXPECT_THAT(long_name.err,
              HasSubstr(name + ": cannot write: File name too long; the pose is not kept any more"));
  EXPECT_THAT(long_name.out, HasSubstr("1 declarations"));
  folder_.write("plain", "");
  EXPECT_THAT(refusal(live("drive.mcap", "--out live --state plain/state.json"), 1),
              HasSubstr("state.json: cannot write: Not a directory"));
}

TEST_F(Live, ARecordingWithoutObservationsIsAnError) {
  for (const char* wrong : {"--scans /nope", "--odometry /nope", "--base-frame nope"})
    EXPECT_THAT(refusal(live("drive.mcap", std::string(wrong) + " --out live")),
                HasSubstr("drive.mcap: error: has no scan whose place odometry tells; name"))
        << wrong;
}

TEST_F(Live, ItsOwnRecordingGivesTheSameAnswers) {
  good(live("drive.mcap", "--tf --out live --record again.mcap"));
  expect_same(comparable("live.steps.jsonl"), steps_of_localize("again.mcap"));
  const Answer info = run("bag info again.mcap");
  for (const char* topic : {"/initialpose", "/glocal/pose", "/glocal/candidates", "/diagnostics"})
    EXPECT_THAT(info.out, HasSubstr(topic));
  EXPECT_THAT(refusal(live("drive.mcap", "--out live --record again.mcap")),
              HasSubstr("again.mcap: error: is there already"));
}

TEST_F(Live, BeginsAnewThoughTheRobotStands) {
  const carmen::CarmenScan scan = carmen::read_carmen_log("room/drive.log").front();
  bags::RobotRecording recording;
  constexpr std::int64_t ms = 1'000'000;
  const auto ask = [&](std::int64_t stamp_ns) {
    recording.add("/glocal/begin", "std_msgs/msg/Empty", stamp_ns, bags::RobotRecording::cdr());
  };
  ask(0);
  for (const std::int64_t stamp : {100 * ms, 200 * ms}) add(recording, scan, stamp);
  ask(250 * ms);
  ask(251 * ms);
  for (const std::int64_t stamp : {300 * ms, 400 * ms}) add(recording, scan, stamp);
  folder_.write("stands.mcap", recording.bytes());
  const Answer answer = good(live("stands.mcap", "--out live"));
  EXPECT_THAT(answer.out, HasSubstr("begins anew"));
  const std::vector<Json> steps = json_lines("live.steps.jsonl");
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_EQ(steps[0]["trial"], 0);
  EXPECT_EQ(steps[1]["trial"], 1);
  EXPECT_EQ(steps[1]["step"], 0);
}

TEST_F(Live, MapToOdomGoesOnWhereTheRobotStands) {
  const auto scans = carmen::read_carmen_log("room/drive.log");
  constexpr std::int64_t ms = 1'000'000, arrival = 200 * ms;
  bags::RobotRecording recording;
  for (const int i : {0, 1, 2}) add(recording, scans.at(static_cast<std::size_t>(i)), i * 100 * ms);
  for (int i = 1; i <= 10; ++i) add(recording, scans.at(2), arrival + i * 100 * ms);
  folder_.write("stands.mcap", recording.bytes());
  good(live("stands.mcap", "--tf --out live --record told.mcap"));
  const Json last_step = json_lines("live.steps.jsonl").back();
  EXPECT_EQ(last_step["verdict"], "localized");
  EXPECT_EQ(last_step["stamp"], 0.2);
  glocal::bags::Recording told("told.mcap");
  told.rewind(std::set<std::string>{"/tf"});
  std::vector<std::int64_t> stamps;
  while (const auto message = told.next()) {
    for (const glocal::bags::FrameTransform& transform : glocal::bags::read_transforms(*message)) {
      if (transform.header.frame == "map") stamps.push_back(transform.header.stamp_ns);
    }
  }
  ASSERT_GE(stamps.size(), 10U);
  EXPECT_EQ(stamps.back(), arrival + 1000 * ms);
  EXPECT_TRUE(std::is_sorted(stamps.begin(), stamps.end()));
}

TEST_F(Live, KnowsAfterAPowerCycleWhereItWas) {
  const std::string state = " --out live --state state.json";
  const Answer first = good(live("drive.mcap", state));
  EXPECT_THAT(first.out, Not(HasSubstr("was at")));
  EXPECT_EQ(Json::parse(content("state.json"))["stamp"], json_lines("live.steps.jsonl").back()["stamp"])
      << "where it was at last";
  // The drive begins anew at its start: the robot was carried there while it was off.
  const Answer second = good(live("drive.mcap", state));
  EXPECT_THAT(second.out, HasSubstr("was at"));
  EXPECT_EQ(json_lines("live.steps.jsonl").back()["verdict"], "localized");

  folder_.write("state.json", "{\"schema\": 1");
  EXPECT_THAT(refusal(live("drive.mcap", state)), HasSubstr("state.json: error: is cut short"));
}

TEST_F(Live, WithViewersAnswersAreTheSame) {
  good(live("drive.mcap", "--out alone --record alone.mcap"));
  const Answer shown = good(live("drive.mcap", "--foxglove --port 0 --out shown --record shown.mcap"));
  EXPECT_THAT(shown.err, HasSubstr("foxglove: ws://127.0.0.1:"));
  expect_same(comparable("shown.steps.jsonl"), comparable("alone.steps.jsonl"));
  // The robot is not told more than without viewers.
  EXPECT_EQ(content("shown.mcap"), content("alone.mcap"));
}

TEST_F(Live, ViewersNeedAPortOfTheirOwn) {
  httplib::Server other;
  const int port = other.bind_to_any_port("127.0.0.1");
  const std::string out = " --out nothing";
  EXPECT_EQ(refusal(live("drive.mcap", fmt::format("--foxglove --port {}", port) + out)),
            fmt::format("--port={}: error: the port is taken; choose another one, or --port 0 for any "
                        "that is free\n1 error\n",
                        port));
  for (const char* wrong :
       {"--port 8765", "--address 127.0.0.1", "--foxglove --port 80", "--foxglove --port 65536",
        "--foxglove --port -1", "--foxglove --port x", "--foxglove --port 0 --address here"})
    EXPECT_EQ(live("drive.mcap", wrong + out).exit_code, 2) << wrong;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
    EXPECT_THAT(entry.path().filename().string(), Not(HasSubstr("nothing")));
}

}  // namespace
}  // namespace glocal::test::live_test
