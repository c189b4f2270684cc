// glocal prepare.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/program.hpp"
#include "files.hpp"
#include "sources/bags/pose_track.hpp"
#include "sources/carmen/carmen_parser.hpp"

namespace glocal::test::prepare_test {
namespace {

using testing::HasSubstr;
using testing::Not;

class PrepareCommand : public CommandLine {
 protected:
  PrepareCommand() {
    write_world();
    std::ofstream(file("experiment.yaml"))
        << "schema: 1\n"
           "name: room\n"
           "map: {simulation: {world: world.yaml}}\n"
           "observations: {simulation: {world: world.yaml, tour_legs: 8, step_length: 0.2}}\n"
           "trials: {whole: true}\n";
    good(run("simulate " + file("experiment.yaml") + " --out " + file("simulated")));
    std::ifstream log(file("simulated/drive.log"));
    std::ofstream raw(file("raw.log"));
    for (std::string line; std::getline(log, line);) {
      if (!line.starts_with("TRUEPOS")) raw << line << '\n';
    }
  }

  /// The true poses ten times a second, their stamps later than they are.
  void write_trajectory(const std::string& name, double late_s) const {
    glocal::bags::PoseTrack track;
    for (const carmen::CarmenScan& scan : carmen::read_carmen_log(file("simulated/drive.log")))
      track.add(std::llround(scan.stamp * 1e9), *scan.map_from_robot);
    track.settle();
    constexpr std::int64_t step_ns = 100'000'000;
    const auto [first, last] = track.span();
    std::ofstream out(file(name));
    out << "# made by a SLAM tool\n";
    for (std::int64_t stamp = first; stamp <= last; stamp += step_ns) {
      const Pose3 pose = *track.at(stamp, last);
      out << fmt::format("{:.6f} {} {} 0 0 0 {} {}\n", static_cast<double>(stamp) * 1e-9 + late_s, pose.x,
                         pose.y, pose.rotation.z(), pose.rotation.w());
    }
  }

  [[nodiscard]] Answer prepare(const std::string& arguments) const { return run("prepare " + arguments); }
};

TEST_F(PrepareCommand, ALogAndATrajectoryBecomeACaseThatRuns) {
  write_trajectory("slam.tum", 0.0);
  const Answer answer = good(prepare("raw.log --corrected slam.tum --out my.case"));
  EXPECT_EQ(answer.err, "");
  EXPECT_THAT(answer.out, HasSubstr("jumps       0 of the reference against odometry\n"));
  EXPECT_THAT(content("my.case/README.md"), HasSubstr("## Warnings\n\nNone.\n"));
  EXPECT_THAT(content("my.case/README.md"), HasSubstr("| reference | slam.tum |"));
  EXPECT_THAT(content("my.case/experiment.yaml"), HasSubstr("\nname: my\n"));
  EXPECT_THAT(content("my.case/provenance.json"), HasSubstr("slam.tum"));
  good(run("map info my.case/map.yaml"));
  std::filesystem::rename("my.case", "moved");
  good(run("run moved/experiment.yaml --quiet --out results"));
  const auto trials = nlohmann::json::parse(content("results/summary.json"))["trials"];
  EXPECT_GT(trials["right"], 0);
  EXPECT_EQ(trials["wrong"], 0);
}

TEST_F(PrepareCommand, AShiftIsFoundAndTheOneThatIsGivenMendsIt) {
  write_trajectory("late.tum", 0.4);
  const std::string inputs = "raw.log --corrected late.tum";
  const Answer late = good(prepare(inputs + " --out late"));
  EXPECT_THAT(late.err, HasSubstr("give --shift -0.4"));
  EXPECT_THAT(content("late/README.md"), HasSubstr("give --shift -0.4"));
  const Answer mended = good(prepare(inputs + " --shift -0.4 --out mended"));
  EXPECT_EQ(mended.err, "");
}

TEST_F(PrepareCommand, ALogWithReferencePosesNeedsNoOther) {
  good(prepare("simulated/drive.log --blocks 2 --map-share 0.6 --out a"));
  EXPECT_THAT(content("a/experiment.yaml"), HasSubstr("segments: [[0, 0.3], [0.5, 0.8]]"));
  EXPECT_THAT(content("a/experiment.yaml"), HasSubstr("segments: [[0.3, 0.5], [0.8, 1]]"));
  good(prepare("raw.log --corrected simulated/drive.log --blocks 2 --map-share 0.6 --out b"));
  EXPECT_EQ(content("a/drive.log"), content("b/drive.log"));
  EXPECT_THAT(refusal(prepare("raw.log --out a")), HasSubstr("the folder exists and is not empty"));
  good(prepare("simulated/drive.log --force --out a"));
  good(prepare("simulated/drive.log --blocks 2 --out c"));
  EXPECT_THAT(content("c/experiment.yaml"), HasSubstr("segments: [[0, 0.15], [0.5, 0.65]]"))
      << "the share is chosen";
}

TEST_F(PrepareCommand, WhatDoesNotFitIsSaid) {
  write_trajectory("slam.tum", 0.0);
  std::ifstream in("slam.tum");
  std::ofstream moved("moved.tum");
  int n = 0;
  for (std::string line; std::getline(in, line);) {
    std::istringstream fields(line);
    std::string stamp, x, rest;
    fields >> stamp >> x;
    std::getline(fields, rest);
    if (line.starts_with('#')) continue;
    moved << stamp << ' ' << std::stod(x) + (++n > 100 ? 1.5 : 0.0) << rest << '\n';
  }
  moved.close();
  const Answer answer = good(prepare("raw.log --corrected moved.tum --out jumps"));
  EXPECT_THAT(answer.err,
              HasSubstr("the reference jumps against odometry, 1 in all; the largest, by 1.50 m"));
}

TEST_F(PrepareCommand, BadInputIsOneErrorAndLeavesNothing) {
  write_trajectory("slam.tum", 0.0);
  write_trajectory("other.tum", 1e6);
  std::ofstream("kitti.txt") << "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 1 0 1 0 0 0 0 1 0\n";
  std::ofstream("one.tum") << "1 0 0 0 0 0 0 1\n";
  std::ofstream("bad.tum") << "1 0 0 0 0 0 0\n";
  std::ofstream("log.relations") << "1 2 0 0 0 0 0\n";
  const auto with = [&](const std::string& name) {
    return prepare("raw.log --corrected " + name + " --out x");
  };
  EXPECT_THAT(refusal(prepare("raw.log --out x")), HasSubstr("has no reference poses; give a trajectory"));
  EXPECT_THAT(refusal(prepare("none.log --out x")), HasSubstr("none.log: error: there is no such file"));
  EXPECT_THAT(refusal(with("other.tum")), HasSubstr("no two scans have a reference pose: scans are from "));
  EXPECT_THAT(refusal(with("kitti.txt")), HasSubstr("has 2 poses without stamps, and there are "));
  EXPECT_THAT(refusal(with("one.tum")), HasSubstr("one.tum: error: has a single pose"));
  EXPECT_THAT(refusal(with("bad.tum")), HasSubstr("bad.tum:1: error: has 7 values"));
  EXPECT_THAT(refusal(prepare("raw.log --corrected slam.tum --relations log.relations --out x")),
              HasSubstr("log.relations:1: error: is no relation"));
  EXPECT_THAT(refusal(prepare("raw.log --corrected slam.tum --reference /pose --out x")),
              HasSubstr("gives the reference poses, and --reference others"));
  EXPECT_FALSE(std::filesystem::exists("x"));
  EXPECT_FALSE(std::filesystem::exists(".x.unfinished"));
}

TEST_F(PrepareCommand, CloudsBecomeACaseInSpace) {
  const std::string drive = dataset("lidar3d/fr_079/drives/d0");
  if (!std::filesystem::exists(drive)) GTEST_SKIP() << "no lidar3d in GLOCAL_DATASETS";
  const Answer answer = good(prepare(drive + " --corrected " + drive + "/poses.tum --out clouds"));
  EXPECT_THAT(answer.out, HasSubstr("scans       25 of 25 with a reference pose"));
  good(run("check clouds/experiment.yaml"));
  EXPECT_TRUE(std::filesystem::exists("clouds/map.pcd"));
}

TEST_F(PrepareCommand, RealDrivesAreChecked) {
  const std::filesystem::path folder = dataset("");
  if (!std::filesystem::exists(folder / "bags/jarvis") || !std::filesystem::exists(folder / "fr079"))
    GTEST_SKIP() << "no bags/jarvis and fr079 in GLOCAL_DATASETS";
  const Answer bag =
      good(prepare((folder / "bags/jarvis/jarvis_circular_path_fast.bag").string() +
                   " --scans /driver_laser_navigation/laser_scan --reference /pose_ground_truth "
                   "--out jarvis"));
  EXPECT_THAT(bag.err, HasSubstr("the scans fit each other better if the reference's stamps are moved by"));
  const Answer log = good(prepare((folder / "fr079/fr079.log.xz").string() + " --relations " +
                                  (folder / "fr079/fr079.relations.xz").string() + " --out fr079"));
  EXPECT_THAT(log.out, HasSubstr("relations   1685: errors of 0.046 m")) << "as the data's README has it";
  EXPECT_THAT(log.err, HasSubstr("the clock of the odometry is off"));
  EXPECT_THAT(log.err, Not(HasSubstr("give --shift")));
}

}  // namespace
}  // namespace glocal::test::prepare_test
