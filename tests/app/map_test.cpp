// glocal map.
#include <gmock/gmock.h>

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/program.hpp"

namespace glocal::test::map_test {
namespace {

namespace fs = std::filesystem;
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
};

TEST_F(MapCommand, BuildsShowsAndConverts) {
  Answer answer = run("map build " + file("drive.log") + " -o " + file("a.yaml") + " --set resolution=0.5");
  EXPECT_EQ(answer.exit_code, 0) << answer.err;
  answer = run("map info " + file("a.yaml"));
  EXPECT_EQ(answer.exit_code, 0) << answer.err;
  // Columns from 0 m to 2 m, rows from -1 m to 0 m; the robot stands in the cell above the axis.
  EXPECT_THAT(answer.out, StartsWith("cells       5 x 3 of 0.5 m: 2.50 m x 1.50 m\n"));
  EXPECT_THAT(answer.out, HasSubstr("occupied    2\nfree        5 (1.2 m^2)\nunknown     8\n"));
  EXPECT_THAT(answer.out, HasSubstr("points      2: x 0.25 to 2.25 m, y -0.75 to 0.25 m\n"));

  EXPECT_EQ(run("map convert " + file("a.yaml") + " -o " + file("b.yaml") + " --image png").exit_code, 0);
  EXPECT_EQ(run("map info " + file("b.yaml")).out, answer.out);
  EXPECT_EQ(run("map convert " + file("a.yaml") + " -o " + file("c.pcd")).exit_code, 0);
  EXPECT_THAT(content(file("c.pcd")), HasSubstr("POINTS 2\n"));
}

TEST_F(MapCommand, AlignsAMapWithACopyInAnotherFrame) {
  const std::string experiment = std::string(GLOCAL_SOURCE_DIR) + "/configs/experiments/paper_lab.yaml";
  ASSERT_EQ(run("map convert " + experiment + " -o " + file("lab.yaml")).exit_code, 0);
  // The same image, laid elsewhere: the corner that was at (-0.015, -0.015) is now at (5, -3), and all is
  // turned by 0.3 rad. So the origin comes to (5, -3) + 0.015 (cos 0.3 - sin 0.3, sin 0.3 + cos 0.3).
  std::string moved = content(file("lab.yaml"));
  const std::size_t origin = moved.find("origin: [");
  moved.replace(origin, moved.find(']', origin) + 1 - origin, "origin: [5, -3, 0.3]");
  std::ofstream(file("moved.yaml")) << moved;
  const Answer info = run("map info " + file("lab.yaml"));
  ASSERT_THAT(info.out, HasSubstr("origin      x -0.015 m, y -0.015 m, yaw 0.00 deg"));

  const Answer answer = run("map align " + file("moved.yaml") + " " + file("lab.yaml") + " --epsilon 0.1");
  ASSERT_EQ(answer.exit_code, 0) << answer.err;
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

  EXPECT_EQ(run("map align " + file("lab.yaml") + " " + experiment + " --epsilon 0").exit_code, 2);
}

TEST_F(MapCommand, SaysWhereMapsDoNotFit) {
  ASSERT_EQ(
      run("map build " + file("drive.log") + " -o " + file("tiny.yaml") + " --set resolution=0.5").exit_code,
      0);
  const std::string lab = std::string(GLOCAL_SOURCE_DIR) + "/configs/experiments/paper_lab.yaml";
  const Answer answer = run("map align " + file("tiny.yaml") + " " + lab);
  EXPECT_EQ(answer.exit_code, 1);
  EXPECT_THAT(answer.err, HasSubstr("does not fit into"));
}

TEST_F(MapCommand, ReplacesFilesOnlyByForce) {
  const std::string build = "map build " + file("drive.log") + " -o " + file("a.yaml");
  EXPECT_EQ(run(build).exit_code, 0);
  const std::string before = content(file("a.yaml"));
  const Answer refused = run(build + " --set resolution=0.5");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err,
              HasSubstr("a.pgm: error: the file exists; choose another name, or replace it with --force"));
  EXPECT_EQ(content(file("a.yaml")), before);
  EXPECT_EQ(run(build + " --set resolution=0.5 --force").exit_code, 0);
  EXPECT_NE(content(file("a.yaml")), before);
}

TEST_F(MapCommand, ReportsFaults) {
  const Answer answer =
      run("map build " + file("drive.log") + " -o " + file("a.yaml") + " --set rez=1 --set segments=3");
  EXPECT_EQ(answer.exit_code, 2);
  EXPECT_THAT(answer.err, HasSubstr("--set rez=1: error: unknown key 'rez'"));
  EXPECT_THAT(answer.err, HasSubstr("--set segments=3: error: segments: expected a list, got '3'"));
  EXPECT_THAT(run("map build " + file("drive.log") + " -o " + file("a.tif")).err,
              HasSubstr("the name must end in .yaml (ROS map) or .pcd (points)"));
  EXPECT_THAT(run("map info " + file("none.yaml")).err, HasSubstr("no such file"));
  EXPECT_EQ(run("map").exit_code, 2);
}

/// A room and an experiment in it that is matched by an index of its map.
class MapIndexCommand : public CommandLine {
 protected:
  MapIndexCommand() {
    std::ofstream(file("world.yaml"))
        << "size: [12, 6]\n"
           "walls: [{points: [[0, 0], [12, 0], [12, 4], [7, 6], [0, 6]], closed: true}]\n"
           "free_from: [[1, 1]]\n"
           "way_points: [[1, 3], [10, 3], [10, 1]]\n";
    std::ofstream(file("room.yaml")) << "schema: 1\n"
                                        "name: room\n"
                                        "map: {simulation: {world: world.yaml}}\n"
                                        "observations: {simulation: {world: world.yaml}}\n"
                                        "trials: {whole: true, max_steps: 10}\n"
                                        "localizer: {matcher: indexed_ransam}\n";
  }
  [[nodiscard]] Answer build(const std::string& options = "") const {
    return run("map index " + file("room.yaml") + " -o " + file("room.index") + " " + options);
  }
  [[nodiscard]] Answer run_room(const std::string& out, const std::string& options = "") const {
    return run("run " + file("room.yaml") + " --quiet --out " + file(out) + " " + options);
  }
  [[nodiscard]] nlohmann::json json(const std::string& name) const {
    return nlohmann::json::parse(content(file(name)));
  }

  const std::string use_ = "--set localizer.matcher.indexed_ransam.index_file=" + file("room.index");
};

TEST_F(MapIndexCommand, ARunWithASavedIndexGivesTheSameAnswers) {
  const Answer answer = build();
  ASSERT_EQ(answer.exit_code, 0) << answer.err;
  std::size_t entries = 0;
  std::size_t bytes = 0;
  ASSERT_EQ(std::sscanf(answer.out.c_str(), "entries %zu bytes %zu build", &entries, &bytes), 2)
      << answer.out;
  EXPECT_GT(entries, 10'000U);
  // The file has a few hundred bytes besides.
  EXPECT_NEAR(static_cast<double>(fs::file_size(file("room.index"))), static_cast<double>(bytes), 1000.0);

  ASSERT_EQ(run_room("built").exit_code, 0);
  const Answer read = run_room("read", use_);
  ASSERT_EQ(read.exit_code, 0) << read.err;
  EXPECT_EQ(content(file("read/trials.jsonl")), content(file("built/trials.jsonl")));
  EXPECT_EQ(content(file("read/trajectories/trial_0000_estimate.tum")),
            content(file("built/trajectories/trial_0000_estimate.tum")));
  EXPECT_NE(content(file("built/trajectories/trial_0000_estimate.tum")), "");
  for (const char* out : {"built", "read"}) {
    const nlohmann::json index = json(out + std::string("/summary.json"))["map"]["index"];
    EXPECT_EQ(index["entries"], entries);
    EXPECT_EQ(index["bytes"], bytes);
  }
  EXPECT_TRUE(json("read/provenance.json")["inputs_sha256"].contains(file("room.index")));
  EXPECT_FALSE(json("built/provenance.json")["inputs_sha256"].contains(file("room.index")));
  // The effective experiment names it by its absolute path.
  EXPECT_EQ(run("run " + file("read/effective.yaml") + " --quiet --out " + file("again")).exit_code, 0);
  EXPECT_EQ(content(file("again/trials.jsonl")), content(file("built/trials.jsonl")));
}

TEST_F(MapIndexCommand, AnIndexThatDoesNotFitIsRefusedUntilItIsBuiltAnew) {
  const Answer none = run_room("a", use_);
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_THAT(none.err, HasSubstr("room.index: error: the index cannot be read: No such file or directory; "
                                  "build it anew: glocal map index EXPERIMENT.yaml --force -o "));
  // A file that names an index that is not there yet can still be what it is built from.
  ASSERT_EQ(build(use_).exit_code, 0);
  ASSERT_EQ(run_room("a", use_).exit_code, 0);

  const std::string longer = use_ + " --set localizer.matcher.indexed_ransam.max_length=7";
  const Answer other_rule = run_room("b", longer);
  EXPECT_EQ(other_rule.exit_code, 2);
  EXPECT_THAT(other_rule.err,
              HasSubstr("was built with other parameters: max_length 6 instead of max_length 7"));
  const Answer other_map =
      run("check " + file("room.yaml") + " --set map.simulation.resolution=0.06 " + use_);
  EXPECT_EQ(other_map.exit_code, 2);
  EXPECT_THAT(other_map.err, HasSubstr("the index belongs to another map"));
  EXPECT_FALSE(fs::exists(file("b")));

  const std::string before = content(file("room.index"));
  const Answer taken = build(longer);
  EXPECT_EQ(taken.exit_code, 2);
  EXPECT_THAT(taken.err, HasSubstr("the file exists"));
  EXPECT_EQ(content(file("room.index")), before);
  EXPECT_EQ(build(longer + " --force").exit_code, 0);
  EXPECT_EQ(run_room("b", longer).exit_code, 0);
}

TEST_F(MapIndexCommand, ARunInSpaceWithASavedIndexGivesTheSameAnswers) {
  std::ofstream(file("room.yaml"))
      << "schema: 1\n"
         "name: room\n"
         "map: {simulation: {world: world.yaml, resolution: 0.1, points: space}}\n"
         "observations: {simulation: {world: world.yaml, lidar: {beams: 16, height: 0.9}}}\n"
         "trials: {whole: true, max_steps: 3}\n"
         "localizer: {motion: upright, local_mapper: odometry, matcher: indexed_ransam}\n";
  const Answer answer = build();
  ASSERT_EQ(answer.exit_code, 0) << answer.err;
  ASSERT_EQ(run_room("built").exit_code, 0);
  const Answer read = run_room("read", use_);
  ASSERT_EQ(read.exit_code, 0) << read.err;
  for (const char* same : {"trials.jsonl", "trajectories/trial_0000_estimate.tum"}) {
    EXPECT_NE(content(file(std::string("built/") + same)), "") << same;
    EXPECT_EQ(content(file(std::string("read/") + same)), content(file(std::string("built/") + same)));
  }
  EXPECT_EQ(json("read/summary.json")["map"]["index"]["bytes"],
            json("built/summary.json")["map"]["index"]["bytes"]);
  EXPECT_TRUE(json("read/provenance.json")["inputs_sha256"].contains(file("room.index")));

  const Answer other_map =
      run("check " + file("room.yaml") + " --set map.simulation.resolution=0.12 " + use_);
  EXPECT_EQ(other_map.exit_code, 2);
  EXPECT_THAT(other_map.err, HasSubstr("the index belongs to another map"));
}

TEST_F(MapIndexCommand, AMatcherWithoutAnIndexIsRefused) {
  const Answer answer = build("--set localizer.matcher=ransam");
  EXPECT_EQ(answer.exit_code, 2);
  EXPECT_THAT(answer.err, HasSubstr("the matcher ransam keeps no index of the map that could be saved"));
  EXPECT_FALSE(fs::exists(file("room.index")));
}

}  // namespace
}  // namespace glocal::test::map_test
