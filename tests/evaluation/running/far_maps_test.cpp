// Whole experiments on one map near the origin of its frame and 500 km away.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "evaluation/results/pcd.hpp"
#include "evaluation/results/pose_json.hpp"
#include "files.hpp"
#include "glocal/builtin.hpp"
#include "glocal/run_experiment.hpp"
#include "sources/ros_map/ros_map_writer.hpp"
#include "sources/simulation/lidar_simulation.hpp"
#include "sources/simulation/simulation.hpp"

namespace glocal::test::far_maps_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Of a place in the UTM zone 31T, m.
constexpr double east = 500'000.0, north = 4'649'776.0;
constexpr double exact = 1e-6;

std::vector<Json> json_lines(const fs::path& file) {
  std::vector<Json> all;
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);) all.push_back(Json::parse(line));
  return all;
}

void expect_moved(const Json& far, const Json& near) {
  ASSERT_EQ(far.size(), near.size());
  for (const auto& [name, value] : near.items()) {
    const double by = name == "x" ? east : name == "y" ? north : 0.0;
    EXPECT_NEAR(far.at(name).get<double>(), value.get<double>() + by, exact) << name;
  }
}

/// A line of results, but for times, is the same far away: all poses in the map are moved, and nothing else.
void expect_same_far_away(const Json& far, const Json& near, const std::string& key = "") {
  if (key == "stage_ms" || key == "stage_cpu_ms") return;
  ASSERT_EQ(far.type(), near.type()) << key;
  if (near.is_object() && near.contains("x") && near.contains("y") && key != "local_from_robot") {
    expect_moved(far, near);
  } else if (near.is_structured()) {
    ASSERT_EQ(far.size(), near.size()) << key << far << near;
    auto of_far = far.begin();
    for (const auto& [name, value] : near.items())
      expect_same_far_away(*of_far++, value, near.is_array() ? key : name);
  } else if (near.is_number_float()) {
    const double size = std::max(1.0, std::abs(near.get<double>()));
    EXPECT_NEAR(far.get<double>(), near.get<double>(), exact * size) << key;
  } else {
    EXPECT_EQ(far, near) << key;
  }
}

class FarMaps : public testing::Test {
 protected:
  FarMaps() {
    register_builtin_strategies(catalog_);
    world_ =
        file_path(folder_.write("world.yaml",
                                "size: [14, 8]\n"
                                "walls:\n"
                                "  - {points: [[0, 0], [14, 0], [14, 5], [9, 8], [0, 8]], closed: true}\n"
                                "rectangles:\n"
                                "  - {centre: [5, 2], size: [1.2, 0.6], angle_deg: 20, height: 1.2}\n"
                                "  - {centre: [11, 5], size: [0.5, 0.8], height: 2}\n"
                                "free_from: [[1, 1]]\n"
                                "way_points: [[1, 4], [8, 4], [12, 2], [3, 1], [2, 6]]\n"));
  }

  /// Runs the experiment NAME.yaml, and answers what it leaves of trials and steps.
  struct Lines {
    std::vector<Json> trials, steps;
    std::size_t right = 0;
  };
  [[nodiscard]] Lines run(const std::string& name, const std::string& text) const {
    folder_.write(name + ".yaml", "schema: 1\nname: room\n" + text);
    const fs::path out = folder_.path() / ("out_" + name);
    const RunResult result =
        run_experiment(folder_.path() / (name + ".yaml"), {}, catalog_, {.out = out.string()}, {});
    return {json_lines(out / "trials.jsonl"), json_lines(out / "steps.jsonl"), result.variants.front().right};
  }

  static void expect_same(const Lines& far, const Lines& near) {
    ASSERT_EQ(far.trials.size(), near.trials.size());
    ASSERT_EQ(far.steps.size(), near.steps.size());
    EXPECT_GE(near.trials.size(), 3U);
    EXPECT_EQ(near.right, near.trials.size());
    for (std::size_t i = 0; i < near.trials.size(); ++i) {
      EXPECT_EQ(far.trials[i]["outcome"], near.trials[i]["outcome"]);
      expect_same_far_away(far.trials[i], near.trials[i]);
    }
    for (std::size_t i = 0; i < near.steps.size(); ++i) expect_same_far_away(far.steps[i], near.steps[i]);
  }

  TemporaryFolder folder_;
  Catalog catalog_;
  FilePath world_;
};

/// The same image, with its corner at the origin and far away.
class FarRosMap : public FarMaps {
 protected:
  FarRosMap() {
    OccupancyGrid grid = simulation::SimulatedMap({.world = world_, .resolution = 0.05}, {}).load().grid;
    folder_.write("map.pgm", ros_map::pgm(ros_map::trinary_image(grid)));
    grid.map_from_grid = {};
    folder_.write("near_map.yaml", ros_map::ros_map_yaml(grid, "map.pgm"));
    folder_.write("far_map.yaml", ros_map::ros_map_yaml(grid, "map.pgm", {east, north, 0.0}));
  }

  [[nodiscard]] Lines run_with(const std::string& name, const std::string& observations) const {
    return run(name, "map: {ros_map: {path: " + name + "_map.yaml}}\nobservations: " + observations +
                         "\nlocalizer: {local_mapper: bounded, matcher: indexed_ransam, verdict_rule: "
                         "staged_margin, verifier: whole_map, threshold_policy: {fixed: {omega_max: 0}}}\n"
                         "trials: {every_m: 5, max_steps: 12, min_steps: 5, within_map_m: 1}\n");
  }
};

TEST_F(FarRosMap, HasTheSameOutcomesAndPosesAsNear) {
  simulation::LaserDriveParams params;
  params.world = world_;
  params.tour_legs = 6;
  std::istringstream near_log(simulation::Simulation(params, {.seed = 3}).recording()->content);
  std::string far_log;
  folder_.write("near.log", near_log.str());
  for (std::string line; std::getline(near_log, line);) {
    std::istringstream words(line);
    std::string key, rest;
    double x = 0.0, y = 0.0;
    if (words >> key >> x >> y && key == "TRUEPOS") {
      std::getline(words, rest);
      line = fmt::format("TRUEPOS {} {}{}", x + east, y + north, rest);
    }
    far_log += line + "\n";
  }
  folder_.write("far.log", far_log);
  const Lines near = run_with("near", "{carmen_log: {path: near.log}}");
  const Lines far = run_with("far", "{carmen_log: {path: far.log}}");
  expect_same(far, near);
}

TEST_F(FarRosMap, ADriveInItIsTheSameAsNear) {
  const auto observations = [](const std::string& name) {
    return "{simulation: {map: " + name + "_map.yaml, tour_legs: 4}}";
  };
  expect_same(run_with("far", observations("far")), run_with("near", observations("near")));
}

TEST_F(FarMaps, ACloudInSpaceHasTheSameOutcomesAndPosesAsNear) {
  const MapData map =
      simulation::SimulatedMap({.world = world_, .resolution = 0.1, .points = "space"}, {}).load();
  // The first point decides where the origin is: near that of the other map.
  Points points;
  points.push_back({0.25F, 0.0F, 0.5F});
  for (std::size_t i = 0; i < map.points.size(); ++i) points.push_back(map.points[i]);
  folder_.write("near.pcd", pcd(points));
  folder_.write("far.pcd", pcd(points, {east, north, 0.0}));
  fs::create_directory(folder_.path() / "scans");
  simulation::LidarDriveParams params;
  params.world = world_;
  params.tour_legs = 5;
  simulation::LidarSimulation drive(params, {.seed = 2, .motion = Motion::upright});
  std::string odometry, near, far;
  while (const auto sample = drive.next()) {
    const double stamp = sample->observation.stamp;
    const auto line = [&](const Pose3& pose) { return fmt::format("{} {}\n", stamp, tum_text(pose)); };
    folder_.write(fmt::format("scans/{}.pcd", stamp), pcd(sample->observation.scan.hits));
    odometry += line(sample->observation.odom_from_robot);
    near += line(*sample->map_from_robot);
    far += line(shifted(*sample->map_from_robot, {east, north, 0.0}));
  }
  folder_.write("odometry.tum", odometry);
  folder_.write("near.tum", near);
  folder_.write("far.tum", far);
  const auto run_of = [&](const std::string& name) {
    return run(
        name,
        "map: {point_cloud: {path: " + name +
            ".pcd}}\nobservations: {cloud_drive: {folder: scans, odometry: odometry.tum, reference: " + name +
            ".tum}}\n"
            "trials: {every_m: 6, max_steps: 8, min_steps: 5, within_map_m: 2}\n"
            "localizer: {motion: upright, local_mapper: lidar_odometry, matcher: surfel_ransam, "
            "threshold_policy: {fixed: {omega_max: 0.1}}, verdict_rule: staged_margin, verifier: "
            "whole_map}\n"
            "evaluation: {max_translation_error: 0.5, max_rotation_error_deg: 10}\n");
  };
  expect_same(run_of("far"), run_of("near"));
}

}  // namespace
}  // namespace glocal::test::far_maps_test
