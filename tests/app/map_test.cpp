// glocal map.
#include <gmock/gmock.h>

#include <cstdio>

#include "app/program.hpp"

namespace glocal::test::map_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class MapCommand : public CommandLine {
 protected:
  /// Four scans from (0, 0): 1 m to the right, 2 m ahead.
  MapCommand() {
    std::ofstream log(file("drive.log"));
    for (int i = 0; i < 4; ++i) {
      log << "TRUEPOS 0 0 0 0 0 0 " << i << " h 0\nFLASER 2 1 2 0 0 0 0 0 0 " << i << " h 0\n";
    }
  }

  /// Writes the map of the paper's laboratory as lab.yaml, and its image laid elsewhere as `name`.
  void write_lab(const std::string& name, const std::string& origin) {
    const std::string experiment = GLOCAL_SOURCE_DIR "/configs/experiments/paper_lab.yaml";
    good(run("map convert " + experiment + " -o " + file("lab.yaml")));
    std::string moved = content(file("lab.yaml"));
    const std::string key = "origin: ";
    const std::size_t at = moved.find(key + "[") + key.size();
    moved.replace(at, moved.find(']', at) + 1 - at, origin);
    std::ofstream(file(name)) << moved;
  }
};

TEST_F(MapCommand, BuildsShowsAndConverts) {
  Answer answer = good(run("map build drive.log -o a.yaml --set resolution=0.5"));
  answer = good(run("map info a.yaml"));
  // Columns from 0 m to 2 m, rows from -1 m to 0 m; the robot stands in the cell above the axis.
  EXPECT_THAT(answer.out, StartsWith("cells       5 x 3 of 0.5 m: 2.50 m x 1.50 m\n"));
  EXPECT_THAT(answer.out, HasSubstr("occupied    2\nfree        5 (1.2 m^2)\nunknown     8\n"));
  EXPECT_THAT(answer.out, HasSubstr("points      2: x 0.25 to 2.25 m, y -0.75 to 0.25 m\n"));

  good(run("map convert a.yaml -o b.yaml --image png"));
  EXPECT_EQ(run("map info b.yaml").out, answer.out);
  EXPECT_THAT(refusal(run("map convert a.yaml -o c.pcd --image png")),
              HasSubstr("c.pcd: error: points have no image; leave out --image, or name a .yaml file"));
  good(run("map convert a.yaml -o c.pcd"));
  EXPECT_THAT(content("c.pcd"), HasSubstr("POINTS 2\n"));
}

TEST_F(MapCommand, AlignsAMapWithACopyInAnotherFrame) {
  // The same image, laid elsewhere: the corner that was at (-0.015, -0.015) is now at (5, -3), and all is
  // turned by 0.3 rad. So the origin comes to (5, -3) + 0.015 (cos 0.3 - sin 0.3, sin 0.3 + cos 0.3).
  write_lab("moved.yaml", "[5, -3, 0.3]");
  const Answer info = run("map info lab.yaml");
  ASSERT_THAT(info.out, HasSubstr("origin      x -0.015 m, y -0.015 m, yaw 0.00 deg"));

  const Answer answer = good(run("map align moved.yaml lab.yaml --epsilon 0.1"));
  double x = 0.0;
  double y = 0.0;
  double yaw = 0.0;
  double percent = 0.0;
  ASSERT_EQ(std::sscanf(answer.out.c_str(), "pose [%lf, %lf, %lf]", &x, &y, &yaw), 3) << answer.out;
  ASSERT_EQ(std::sscanf(answer.out.substr(answer.out.find("contact")).c_str(), "contact %lf", &percent), 1);
  EXPECT_NEAR(x, 5.0099, 0.01);
  EXPECT_NEAR(y, -2.9812, 0.01);
  EXPECT_NEAR(yaw, 17.19, 0.06);  // 0.3 rad
  EXPECT_GT(percent, 99.0);

  EXPECT_EQ(run("map align lab.yaml moved.yaml --epsilon 0").exit_code, 2);
}

TEST_F(MapCommand, KeepsTheFrameOfAMapFarAway) {
  std::ofstream("far.pgm") << "P2 2 2 255\n0 255\n255 0\n";
  std::ofstream("far.yaml") << "image: far.pgm\nresolution: 0.5\norigin: [500000.25, 4649776, 0]\n";
  const Answer info = run("map info far.yaml");
  EXPECT_THAT(info.out, HasSubstr("origin      x 500000.250 m, y 4649776.000 m, yaw 0.00 deg\n"));
  EXPECT_THAT(info.out,
              HasSubstr("points      2: x 500000.50 to 500001.00 m, y 4649776.25 to 4649776.75 m\n"));
  good(run("map convert far.yaml -o again.yaml"));
  EXPECT_THAT(content("again.yaml"), HasSubstr("origin: [500000.25, 4649776, 0]\n"));
  good(run("map convert far.yaml -o far.pcd"));
  EXPECT_THAT(content("far.pcd"), HasSubstr("SIZE 8 8 8\n"));
  std::ofstream("cloud.yaml") << "schema: 1\nname: cloud\nmap: {point_cloud: {path: far.pcd}}\n"
                                 "observations: {carmen_log: {path: drive.log}}\n"
                                 "trials: {whole: true}\n";
  EXPECT_THAT(run("map info cloud.yaml").out,
              HasSubstr("points      2: x 500000.50 to 500001.00 m, y 4649776.25 to 4649776.75 m\n"));
}

TEST_F(MapCommand, AlignsAMapWithOneFarAway) {
  write_lab("far.yaml", "[500000, 4649776, 0]");
  const Answer answer = run("map align far.yaml lab.yaml --epsilon 0.1");
  double x = 0.0, y = 0.0, yaw = 0.0;
  ASSERT_EQ(std::sscanf(answer.out.c_str(), "pose [%lf, %lf, %lf]", &x, &y, &yaw), 3) << answer.out;
  EXPECT_NEAR(x, 500'000.015, 0.02);
  EXPECT_NEAR(y, 4'649'776.015, 0.02);
  EXPECT_NEAR(yaw, 0.0, 0.06);
}

TEST_F(MapCommand, SaysWhereMapsDoNotFit) {
  good(run("map build drive.log -o tiny.yaml --set resolution=0.5"));
  const std::string lab = GLOCAL_SOURCE_DIR "/configs/experiments/paper_lab.yaml";
  EXPECT_THAT(refusal(run("map align tiny.yaml " + lab), 1), HasSubstr("does not fit into"));
}

TEST_F(MapCommand, ReplacesFilesOnlyByForce) {
  const std::string build = "map build drive.log -o a.yaml";
  good(run(build));
  const std::string before = content("a.yaml");
  EXPECT_THAT(refusal(run(build + " --set resolution=0.5")),
              HasSubstr("a.pgm: error: the file exists; choose another name, or replace it with --force"));
  EXPECT_EQ(content("a.yaml"), before);
  good(run(build + " --set resolution=0.5 --force"));
  EXPECT_NE(content("a.yaml"), before);
}

TEST_F(MapCommand, ReportsFaults) {
  const std::string said = refusal(run("map build drive.log -o a.yaml --set rez=1 --set segments=3"));
  EXPECT_THAT(said, HasSubstr("--set rez=1: error: unknown key 'rez'"));
  EXPECT_THAT(said, HasSubstr("--set segments=3: error: segments: expected a list, got '3'"));
  EXPECT_THAT(run("map build drive.log -o a.tif").err,
              HasSubstr("the name must end in .yaml (ROS map) or .pcd (points)"));
  EXPECT_THAT(run("map info none.yaml").err, HasSubstr("no such file"));
  EXPECT_EQ(run("map").exit_code, 2);
  EXPECT_THAT(refusal(run("map info drive.log")), HasSubstr("drive.log: error: is no YAML file"));
  good(run("map build drive.log -o a.yaml"));
  for (const std::string change : {"--set resolution=1", "--seed 3", "--threads 2"})
    EXPECT_THAT(refusal(run("map info a.yaml " + change)),
                HasSubstr("a.yaml: error: is a ROS map, in which nothing can be changed; leave out --"));
}

}  // namespace
}  // namespace glocal::test::map_test
