// glocal prepare.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/program.hpp"
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
  const Answer answer =
      good(prepare(file("raw.log") + " --corrected " + file("slam.tum") + " --out " + file("my.case")));
  EXPECT_EQ(answer.err, "");
  EXPECT_THAT(answer.out, HasSubstr("jumps       0 of the reference against odometry\n"));
  EXPECT_THAT(content(file("my.case/README.md")), HasSubstr("## Warnings\n\nNone.\n"));
  EXPECT_THAT(content(file("my.case/README.md")), HasSubstr("| reference | slam.tum |"));
  EXPECT_THAT(content(file("my.case/experiment.yaml")), HasSubstr("\nname: my\n"));
  EXPECT_THAT(content(file("my.case/provenance.json")), HasSubstr("slam.tum"));
  good(run("map info " + file("my.case/map.yaml")));
  std::filesystem::rename(file("my.case"), file("moved"));
  good(run("run " + file("moved/experiment.yaml") + " --quiet --out " + file("results")));
  const auto trials = nlohmann::json::parse(content(file("results/summary.json")))["trials"];
  EXPECT_GT(trials["right"], 0);
  EXPECT_EQ(trials["wrong"], 0);
}

TEST_F(PrepareCommand, AShiftIsFoundAndTheOneThatIsGivenMendsIt) {
  write_trajectory("late.tum", 0.4);
  const std::string inputs = file("raw.log") + " --corrected " + file("late.tum");
  const Answer late = good(prepare(inputs + " --out " + file("late")));
  EXPECT_THAT(late.err, HasSubstr("give --shift -0.4"));
  EXPECT_THAT(content(file("late/README.md")), HasSubstr("give --shift -0.4"));
  const Answer mended = good(prepare(inputs + " --shift -0.4 --out " + file("mended")));
  EXPECT_EQ(mended.err, "");
}

TEST_F(PrepareCommand, ALogWithReferencePosesNeedsNoOther) {
  good(prepare(file("simulated/drive.log") + " --blocks 2 --map-share 0.6 --out " + file("a")));
  EXPECT_THAT(content(file("a/experiment.yaml")), HasSubstr("segments: [[0, 0.3], [0.5, 0.8]]"));
  EXPECT_THAT(content(file("a/experiment.yaml")), HasSubstr("segments: [[0.3, 0.5], [0.8, 1]]"));
  good(prepare(file("raw.log") + " --corrected " + file("simulated/drive.log") + " --blocks 2" +
               " --map-share 0.6 --out " + file("b")));
  EXPECT_EQ(content(file("a/drive.log")), content(file("b/drive.log")));
  EXPECT_THAT(refusal(prepare(file("raw.log") + " --out " + file("a"))),
              HasSubstr("the folder exists and is not empty"));
  good(prepare(file("simulated/drive.log") + " --force --out " + file("a")));
  good(prepare(file("simulated/drive.log") + " --blocks 2 --out " + file("c")));
  EXPECT_THAT(content(file("c/experiment.yaml")), HasSubstr("segments: [[0, 0.15], [0.5, 0.65]]"))
      << "the share is chosen";
}

TEST_F(PrepareCommand, WhatDoesNotFitIsSaid) {
  write_trajectory("slam.tum", 0.0);
  std::ifstream in(file("slam.tum"));
  std::ofstream moved(file("moved.tum"));
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
  const Answer answer =
      good(prepare(file("raw.log") + " --corrected " + file("moved.tum") + " --out " + file("jumps")));
  EXPECT_THAT(answer.err,
              HasSubstr("the reference jumps against odometry, 1 in all; the largest, by 1.50 m"));
}

TEST_F(PrepareCommand, BadInputIsOneErrorAndLeavesNothing) {
  write_trajectory("slam.tum", 0.0);
  write_trajectory("other.tum", 1e6);
  std::ofstream(file("kitti.txt")) << "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 1 0 1 0 0 0 0 1 0\n";
  std::ofstream(file("one.tum")) << "1 0 0 0 0 0 0 1\n";
  std::ofstream(file("bad.tum")) << "1 0 0 0 0 0 0\n";
  std::ofstream(file("log.relations")) << "1 2 0 0 0 0 0\n";
  const auto with = [&](const std::string& name) {
    return prepare(file("raw.log") + " --corrected " + file(name) + " --out " + file("x"));
  };
  EXPECT_THAT(refusal(prepare(file("raw.log") + " --out " + file("x"))),
              HasSubstr("has no reference poses; give a trajectory"));
  EXPECT_THAT(refusal(prepare(file("none.log") + " --out " + file("x"))),
              HasSubstr("none.log: error: there is no such file"));
  EXPECT_THAT(refusal(with("other.tum")), HasSubstr("no two scans have a reference pose: scans are from "));
  EXPECT_THAT(refusal(with("kitti.txt")), HasSubstr("has 2 poses without stamps, and there are "));
  EXPECT_THAT(refusal(with("one.tum")), HasSubstr("one.tum: error: has a single pose"));
  EXPECT_THAT(refusal(with("bad.tum")), HasSubstr("bad.tum:1: error: has 7 values"));
  EXPECT_THAT(refusal(prepare(file("raw.log") + " --corrected " + file("slam.tum") + " --relations " +
                              file("log.relations") + " --out " + file("x"))),
              HasSubstr("log.relations:1: error: is no relation"));
  EXPECT_THAT(refusal(prepare(file("raw.log") + " --corrected " + file("slam.tum") +
                              " --reference /pose --out " + file("x"))),
              HasSubstr("gives the reference poses, and --reference others"));
  EXPECT_FALSE(std::filesystem::exists(file("x")));
  EXPECT_FALSE(std::filesystem::exists(file(".x.unfinished")));
}

TEST_F(PrepareCommand, CloudsBecomeACaseInSpace) {
  const char* const data = std::getenv("GLOCAL_DATASETS");
  const std::string drive = std::string(data == nullptr ? "" : data) + "/lidar3d/fr_079/drives/d0";
  if (!std::filesystem::exists(drive)) GTEST_SKIP() << "no lidar3d in GLOCAL_DATASETS";
  const Answer answer = good(prepare(drive + " --corrected " + drive + "/poses.tum --out " + file("clouds")));
  EXPECT_THAT(answer.out, HasSubstr("scans       25 of 25 with a reference pose"));
  good(run("check " + file("clouds/experiment.yaml")));
  EXPECT_TRUE(std::filesystem::exists(file("clouds/map.pcd")));
}

TEST_F(PrepareCommand, RealDrivesAreChecked) {
  const char* const data = std::getenv("GLOCAL_DATASETS");
  const std::filesystem::path folder = data == nullptr ? "" : data;
  if (!std::filesystem::exists(folder / "bags/jarvis") || !std::filesystem::exists(folder / "fr079"))
    GTEST_SKIP() << "no bags/jarvis and fr079 in GLOCAL_DATASETS";
  const Answer bag =
      good(prepare((folder / "bags/jarvis/jarvis_circular_path_fast.bag").string() +
                   " --scans /driver_laser_navigation/laser_scan --reference /pose_ground_truth "
                   "--out " +
                   file("jarvis")));
  EXPECT_THAT(bag.err, HasSubstr("the scans fit each other better if the reference's stamps are moved by"));
  const Answer log =
      good(prepare((folder / "fr079/fr079.log.xz").string() + " --relations " +
                   (folder / "fr079/fr079.relations.xz").string() + " --out " + file("fr079")));
  EXPECT_THAT(log.out, HasSubstr("relations   1685: errors of 0.046 m")) << "as the data's README has it";
  EXPECT_THAT(log.err, HasSubstr("the clock of the odometry is off"));
  EXPECT_THAT(log.err, Not(HasSubstr("give --shift")));
}

}  // namespace
}  // namespace glocal::test::prepare_test
