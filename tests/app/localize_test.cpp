// glocal localize.
#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/program.hpp"
#include "files.hpp"
#include "octree_files.hpp"
#include "sources/bags/message_writer.hpp"
#include "sources/carmen/carmen_parser.hpp"

namespace glocal::test::localize_test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// A simulated room: a map, and a drive as a log and as a recording.
class Localize : public CommandLine {
 protected:
  Localize() {
    simulate_room();
    write_recording();
  }

  /// A scan a second; a laser that looks the same way as the robot.
  void write_recording() const {
    bags::RobotRecording recording;
    for (const carmen::CarmenScan& scan : carmen::read_carmen_log(file("room/drive.log"))) {
      const auto stamp = static_cast<std::int64_t>(scan.stamp * 1e9);
      recording.transform("odom", "base_link", stamp, scan.odom_from_robot);
      recording.transform("base_link", "laser", stamp, {}, "/tf_static");
      recording.pose("/truth", stamp, "map", *scan.map_from_robot);
      recording.scan("/scan", stamp,
                     {.angle_min = static_cast<float>(scan.start_angle),
                      .angle_increment = static_cast<float>(scan.angle_step),
                      .range_max = static_cast<float>(scan.max_range),
                      .ranges = scan.ranges});
      recording.scan("/narrow", stamp, {.angle_increment = 0.01F, .ranges = {1.0F, 1.0F, 1.0F}});
    }
    folder_.write("room/drive.mcap", recording.bytes());
  }

  [[nodiscard]] Answer localize(const std::string& log, const std::string& options = "") const {
    return run("localize " + file("room/map.yaml") + " " + file(log) + " --out " + file("answer") + " " +
               options);
  }
};

TEST_F(Localize, AMapAndARecordingAreEnough) {
  const Answer answer = good(localize("room/drive.mcap", "--reference /truth"));
  EXPECT_THAT(answer.out, HasSubstr("scans       /scan: 1.0 Hz, 541 beams over 270.0 deg"));
  EXPECT_THAT(answer.out, HasSubstr("not used    /narrow"));
  EXPECT_THAT(answer.out, HasSubstr("robot       base_link, odometry by tf from odom"));
  EXPECT_THAT(answer.out, HasSubstr("step   0    0.00 m"));
  EXPECT_THAT(answer.out, HasSubstr("localized after "));
  EXPECT_THAT(answer.out, HasSubstr("(right: 0.0"));
  EXPECT_THAT(content("answer.html"), HasSubstr("<html"));
}

TEST_F(Localize, ErrorsNameItsOptions) {
  EXPECT_THAT(refusal(run("convert room/drive.mcap -o a.log")),
              HasSubstr("has several topics with scans; set --scans to those of one sensor"));
  EXPECT_THAT(refusal(localize("room/drive.mcap", "--odom-frame world")),
              HasSubstr("set --odom-frame and --base-frame to frames of the tree"));
  good(localize("room/drive.mcap", "--odom-frame odom --base-frame base_link"));
}

TEST_F(Localize, RefusesMapsThatNoMachineHoldsBeforeAnythingIsMade) {
  const auto answer_of = [&](float resolution, const Pose2& origin) {
    bags::RobotRecording recording;
    recording.grid("/map", 0, resolution, 3, {100, 0, 100, 0, 0, 0, 100, 0, 100}, origin);
    folder_.write("map.mcap", recording.bytes());
    return run("localize map.mcap room/drive.mcap --force --out answer");
  };
  for (const float resolution : {1e-6F, 1e-30F, 0.0F, 1e30F})
    EXPECT_THAT(refusal(answer_of(resolution, {})), HasSubstr("must be 0.001 to 100 m"));
  EXPECT_THAT(refusal(answer_of(0.05F, {-1e7, 1e7, 0.0})), HasSubstr("at most 1e+07 m are allowed"));
  good(answer_of(0.05F, {5e5, 5.4e6, 0.0}));  // Coordinates on Earth.
}

TEST_F(Localize, WithoutReferencesItTellsWhetherItAgreesWithItself) {
  const Answer answer = good(localize("room/drive.mcap", "--every 2"));
  EXPECT_THAT(answer.out, HasSubstr("declared without reference pose"));
  EXPECT_THAT(answer.out, HasSubstr("all declared poses agree with each other along the drive"));
  EXPECT_THAT(answer.out, Not(HasSubstr("success")));
}

TEST_F(Localize, TheExperimentThatItWritesGivesTheSameAnswer) {
  good(localize("room/drive.mcap"));
  good(run("run answer.yaml --out again"));
  EXPECT_EQ(content("again/trials.jsonl"), content("answer/trials.jsonl"));
  EXPECT_THAT(content("answer.yaml"), HasSubstr("scans: [\"/scan\"]"));
}

TEST_F(Localize, CarmenLogsAreReadAsWell) {
  const Answer answer = good(localize("room/drive.log", "--every 3"));
  EXPECT_THAT(answer.out, HasSubstr("from 0.0 m: localized after "));
  EXPECT_THAT(answer.out, HasSubstr("  trials              "));
  EXPECT_THAT(answer.out, Not(HasSubstr(" wrong: ")));
}

TEST_F(Localize, AnAnswerThatIsInTheWayStays) {
  good(localize("room/drive.mcap"));
  EXPECT_THAT(refusal(localize("room/drive.mcap", "--start 2")), HasSubstr("answer.yaml"));
  good(localize("room/drive.mcap", "--start 2 --force"));
}

TEST_F(Localize, APageThatIsInTheWayIsToldBeforeAnythingIsMade) {
  folder_.write("answer.html", "mine");
  EXPECT_THAT(refusal(localize("room/drive.mcap")), HasSubstr("answer.html: error: the file exists"));
  EXPECT_FALSE(std::filesystem::exists("answer.yaml"));
  EXPECT_FALSE(std::filesystem::exists("answer"));
  EXPECT_EQ(content("answer.html"), "mine");
}

TEST_F(Localize, AnInterruptedRunIsGoneOnWithAndItsPageRenewed) {
  good(localize("room/drive.mcap"));
  auto summary = nlohmann::ordered_json::parse(content("answer/summary.json"));
  summary["complete"] = false;
  folder_.write("answer/summary.json", summary.dump());
  folder_.write("answer.html", "of some trials");
  good(localize("room/drive.mcap"));
  EXPECT_THAT(content("answer.html"), HasSubstr("<html"));
  std::filesystem::remove_all("answer");
  EXPECT_THAT(refusal(localize("room/drive.mcap")), HasSubstr("answer.html: error: the file exists"));
}

TEST_F(Localize, WhatIsNeitherMapNorLogIsRefused) {
  folder_.write("notes.txt", "hello\n");
  EXPECT_THAT(refusal(run("localize notes.txt room/drive.mcap")),
              HasSubstr("notes.txt: error: is no map that is known"));
  EXPECT_THAT(refusal(localize("absent.bag")),
              HasSubstr("absent.bag: error: there is no such file or folder"));
  EXPECT_THAT(refusal(localize("room/drive.log", "--reference /truth")),
              HasSubstr("drive.log: error: is taken for a CARMEN log"));
  folder_.write("clouds/1.pcd", "");
  for (const std::string option : {"--scans", "--odom-frame", "--base-frame"})
    EXPECT_THAT(refusal(localize("clouds", option + " x")),
                HasSubstr("clouds: error: a folder of clouds has no topics: leave out " + option + "\n"));
  EXPECT_EQ(content("answer.yaml"), "");
}

TEST_F(Localize, ARealDriveIsFoundInItsBuildingsPlan) {
  const auto folder = dataset("bags/jarvis");
  if (folder.empty()) GTEST_SKIP() << "set GLOCAL_DATASETS to run this";
  const Answer answer =
      good(run("localize " + (folder / "i-108_10mm.yaml").string() + " " +
               (folder / "jarvis_circular_path_fast.bag").string() +
               " --every 2 --reference /pose_ground_truth --set observations.bag.reference.x=14.60635 --set "
               "observations.bag.reference.y=3.34242 --set observations.bag.reference.yaw_deg=-1.53605 --set "
               "observations.bag.reference.time_shift=0.135 --out answer"));
  EXPECT_THAT(answer.out, HasSubstr("trials              6: 6 right, 0 wrong, 0 undecided"));
  EXPECT_THAT(
      content("answer.yaml"),
      HasSubstr("# Not in here, but changed on the command line: --set observations.bag.reference.x="));
}

TEST_F(Localize, WithoutItsPluginAnOctreeIsACloudOfOccupiedVoxels) {
  for (const std::string name : {"tree.bt", "tree.bt.gz"}) {
    folder_.write(name, bt_file({{}, {.x = 32800}, {.y = 32800}}, 0.1));
    EXPECT_THAT(run("localize " + name + " room/drive.mcap --force --out answer").out,
                HasSubstr("map         an octree, its occupied voxels only: the plugin octomap, which reads "
                          "the free ones, is not loaded\n"));
    EXPECT_THAT(content("answer.yaml"), HasSubstr("point_cloud: {path: "));
  }
}

}  // namespace
}  // namespace glocal::test::localize_test
