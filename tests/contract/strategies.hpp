// Every registered strategy, ready to be made.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <string>

#include "files.hpp"
#include "glocal/builtin.hpp"
#include "glocal/yaml.hpp"
#include "loading/plugin_loader.hpp"
#include "matchers/grid_search/exhaustive.hpp"
#include "matchers/mcl/mcl.hpp"
#include "octree_files.hpp"
#include "sources/bags/bag_drive.hpp"
#include "sources/bags/bag_map.hpp"
#include "sources/bags/message_writer.hpp"
#include "sources/carmen/carmen_log.hpp"
#include "sources/carmen/log_map.hpp"
#include "sources/clouds/cloud_drive.hpp"
#include "sources/clouds/cloud_drive_map.hpp"
#include "sources/clouds/cloud_pair.hpp"
#include "sources/clouds/point_cloud_map.hpp"
#include "sources/disturbed/disturbed_drive.hpp"
#include "sources/disturbed/disturbed_map.hpp"
#include "sources/live/live_drive.hpp"
#include "sources/live/live_map.hpp"
#include "sources/live/recording_link.hpp"
#include "sources/ros_map/ros_map.hpp"
#include "sources/several/several_drives.hpp"
#include "sources/several/several_maps.hpp"
#include "sources/simulation/lidar_simulation.hpp"
#include "sources/simulation/random_scans.hpp"
#include "sources/simulation/simulation.hpp"
#include "sources/sites/office.hpp"
#include "test_world.hpp"

namespace glocal::test {

class Contract : public ::testing::Test {
 protected:
  Contract() {
    register_builtin_strategies(catalog_);
    PluginLoader(catalog_).load_folders(GLOCAL_PLUGINS_FOLDER);
    world_ =
        file_path(folder_.write("world.yaml",
                                "size: [6, 4]\n"
                                "walls: [{points: [[0, 0], [6, 0], [6, 4], [2, 4], [0, 3]], closed: true}]\n"
                                "free_from: [[1, 1]]\nway_points: [[1, 1], [4, 1], [4, 3]]\n"));
    log_ = file_path(folder_.write("drive.log",
                                   "TRUEPOS 0 0 0 0 0 0 0 host 0\n"
                                   "FLASER 3 2.0 1.0 1.5 0 0 0 0 0 0 0 host 0\n"
                                   "TRUEPOS 1 0 0 1 0 0 1 host 1\n"
                                   "FLASER 3 1.9 1.1 1.5 1 0 0 1 0 0 1 host 1\n"
                                   "TRUEPOS 2 0 0.5 2 0 0.5 2 host 2\n"
                                   "FLASER 3 2.0 1.0 1.5 2 0 0.5 2 0 0.5 2 host 2\n"));
    folder_.write("map.pgm", std::string("P5\n3 2\n255\n") + std::string("\x00\xfe\xfe\xfe\xcd\x00", 6));
    ros_map_ = file_path(folder_.write("map.yaml",
                                       "image: map.pgm\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\n"
                                       "occupied_thresh: 0.65\nfree_thresh: 0.196\n"));
    fill<simulation::Simulation::Params>("observation_source/simulation", [&](auto& p) { p.world = world_; });
    fill<simulation::LidarSimulation::Params>("observation_source/lidar_simulation",
                                              [&](auto& p) { p.world = world_; });
    const auto make_small = [](sites::OfficeParams& p) {
      p.side = 20.0;
      p.length = 10.0;
    };
    fill<sites::OfficeDrive::Params>("observation_source/office", make_small);
    fill<sites::OfficeMap::Params>("map_source/office", make_small);
    fill<disturbed::DisturbedDrive::Params>("observation_source/disturbed", [&](auto& p) {
      p.source = catalog_.observation_sources.choose("carmen_log");
      fillers_.at("observation_source/carmen_log")(*p.source.params);
      p.by = {{{"people", 3, {}}}, {{"spinning_wheels", 3, {}}}};
    });
    fill<disturbed::DisturbedMap::Params>("map_source/disturbed", [&](auto& p) {
      p.source = catalog_.map_sources.choose("ros_map");
      fillers_.at("map_source/ros_map")(*p.source.params);
      p.by = {{{"brought", 3, {}}}};
    });
    fill<several::SeveralMaps::Params>("map_source/several", [&](auto& p) {
      p.maps = {{p.sources, "ground", p.sources->choose("ros_map")}};
      fillers_.at("map_source/ros_map")(*p.maps[0].source.params);
    });
    fill<several::SeveralDrives::Params>("observation_source/several", [&](auto& p) {
      p.drives = {{p.sources, "ground", p.sources->choose("carmen_log")}};
      fillers_.at("observation_source/carmen_log")(*p.drives[0].source.params);
    });
    fill<carmen::LogParams>("observation_source/carmen_log", [&](auto& p) { p.path = log_; });
    fill<simulation::RandomScans::Params>("observation_source/random_scans", [&](auto& p) {
      p.map.path = ros_map_;
      p.count = 3;
      p.clearance = 0.0;
    });
    fill<simulation::SimulatedMap::Params>("map_source/simulation", [&](auto& p) { p.world = world_; });
    fill<ros_map::RosMap::Params>("map_source/ros_map", [&](auto& p) { p.path = ros_map_; });
    fill<carmen::LogMap::Params>("map_source/log_map", [&](auto& p) {
      p.log.path = log_;
      p.min_hits = 1;
    });
    const std::string cloud =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "end_header\n1 0 0\n0 1 0\n0 0 1\n";
    std::filesystem::create_directory(folder_ / "clouds");
    folder_.write("clouds/0.ply", cloud);
    folder_.write("clouds/1.ply", cloud);
    fill<clouds::CloudDrive::Params>("observation_source/cloud_drive",
                                     [&](auto& p) { p.folder = file_path(folder_ / "clouds"); });
    const FilePath poses = file_path(folder_.write("poses.tum", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n"));
    fill<clouds::CloudDriveMap::Params>("map_source/cloud_drive", [&, poses](auto& p) {
      p.drive.folder = file_path(folder_ / "clouds");
      p.drive.reference = poses;
    });
    const FilePath pairs =
        file_path(folder_.write("pairs.csv", "source,target\nclouds/0.ply,clouds/1.ply\n"));
    fill<clouds::CloudPairMap::Params>("map_source/cloud_pair", [pairs](auto& p) { p.list = pairs; });
    fill<clouds::CloudPairScan::Params>("observation_source/cloud_pair",
                                        [pairs](auto& p) { p.list = pairs; });
    fill<clouds::PointCloudMap::Params>("map_source/point_cloud",
                                        [&](auto& p) { p.path = file_path(folder_ / "clouds/0.ply"); });
    fill<grid_search::Exhaustive::Params>("matcher/exhaustive", [](auto& p) {
      // Defaults would take minutes.
      p.matching.grid.contact_epsilon = 0.2;
      p.matching.grid.cell = 0.2;
      p.matching.grid.min_rotation_step_deg = 2.9;
    });
    // So that some of the particles fit well enough after a single scan.
    fill<mcl::Mcl::Params>("matcher/mcl", [](auto& p) {
      p.max_particles = 20000;
      p.merging.distance = 0.1;
      p.merging.rotation = radians(2.9);
      p.contact_epsilon = 0.3;
    });
    bags::RobotRecording recording;
    for (const int i : {0, 1}) {
      const std::int64_t stamp = 100'000'000L * i;
      recording.transform("odom", "base_link", stamp, Pose2{0.5 * i, 0.0, 0.0});
      recording.scan("/scan", stamp, {.frame = "base_link", .angle_increment = 0.5F, .ranges = {2.0F, 3.0F}});
    }
    recording.grid("/map", 0, 0.1F, 3, {0, 0, 100});
    const FilePath bag = file_path(folder_.write("drive.mcap", recording.bytes()));
    fill<glocal::bags::BagDrive::Params>("observation_source/bag", [&, bag](auto& p) { p.path = bag; });
    fill<glocal::bags::BagMap::Params>("map_source/bag_map", [&, bag](auto& p) { p.path = bag; });
    const auto play = [&, bag](AnyParams& any) {
      dynamic_cast<ParamsOf<glocal::live::RecordingLink::Params>&>(any).value.path = bag;
    };
    fillers_["message_link/recording"] = play;
    const auto from_recording = [&, play](auto& p) {
      p.link = catalog_.message_links.choose("recording");
      play(*p.link.params);
    };
    fill<glocal::live::LiveDrive::Params>("observation_source/ros2", from_recording);
    fill<glocal::live::LiveMap::Params>("map_source/ros2_map", from_recording);
    const std::string tree = folder_.write("tree.bt", bt_file({{}, {.x = 32770, .log_odds = -1.0F}}, 0.1));
    const std::string tree_params = folder_.write("tree.yaml", "path: " + tree + "\n");
    fillers_["map_source/octomap"] = [tree_params](AnyParams& any) { read_yaml(tree_params, any); };
    const std::string filter = folder_.write("filter.yaml", "contact_epsilon: 0.3\n");
    // On this computer alone.
    setenv("CYCLONEDDS_URI", "<General><Interfaces><NetworkInterface name='lo'/></Interfaces></General>", 1);
    fillers_["message_link/ros2"] = [](AnyParams&) {};
    fillers_["matcher/mrpt_mcl"] = [filter](AnyParams& any) { read_yaml(filter, any); };
    for (const char* stage : {"local_mapper/scan_matching",
                              "local_mapper/bounded",
                              "local_mapper/keyframes",
                              "local_mapper/lidar_odometry",
                              "local_mapper/odometry",
                              "contact_index/bitset",
                              "contact_index/kd_tree",
                              "contact_index/pcl_kd_tree",
                              "matcher/open3d_fgr",
                              "matcher/open3d_ransac",
                              "matcher/pcl_icp",
                              "matcher/pcl_cloud_prerejective",
                              "matcher/pcl_prerejective",
                              "local_mapper/octomap",
                              "matcher/ransam",
                              "matcher/triangle_ransam",
                              "matcher/indexed_ransam",
                              "matcher/surfel_ransam",
                              "matcher/branch_and_bound",
                              "matcher/upright_branch_and_bound",
                              "matcher/ransac",
                              "matcher/iransac",
                              "threshold_policy/fixed",
                              "verdict_rule/staged_margin",
                              "clusterer/hierarchical_kmeans",
                              "rater/cluster_rating",
                              "rater/quality_only",
                              "rater/softmax",
                              "threshold_policy/exponential",
                              "threshold_policy/quantile",
                              "threshold_policy/best_fraction",
                              "clusterer/dbscan",
                              "clusterer/mean_shift",
                              "clusterer/pose_grid",
                              "threshold_policy/sliding_window",
                              "verdict_rule/consecutive_rating",
                              "verifier/none",
                              "verifier/whole_map",
                              "cloud_registrar/open3d_fgr",
                              "cloud_registrar/open3d_ransac",
                              "cloud_registrar/pcl_prerejective",
                              "cloud_registrar/surfel_pairs"}) {
      fillers_[stage] = [](AnyParams&) {};
    }
  }

  /// A strategy with its defaults, and what it requires besides. A strategy that has no entry above fails the
  /// test: give it one.
  StrategyChoice choice(const RegistryBase& registry, const StrategyInfo& info) const {
    StrategyChoice chosen = registry.choose(info.name);
    const auto filler = fillers_.find(registry.kind() + "/" + info.name);
    if (filler == fillers_.end()) {
      ADD_FAILURE() << registry.kind() << " " << info.name
                    << " has no entry in tests/contract/strategies.hpp";
    } else {
      filler->second(*chosen.params);
    }
    return chosen;
  }

  template <class Interface, class Setup, class Test>
  void for_each(const Registry<Interface, Setup>& registry, Test test) const {
    ASSERT_FALSE(registry.all().empty()) << registry.kind();
    for (const StrategyInfo* info : registry.all()) {
      // The worlds of these tests are flat.
      if (!info->motions.planar) continue;
      SCOPED_TRACE(registry.kind() + " " + info->name);
      test(choice(registry, *info));
    }
  }

  TemporaryFolder folder_;
  Catalog catalog_;

 private:
  template <class Params, class Fill>
  void fill(const std::string& name, Fill fill_in) {
    fillers_[name] = [fill_in](AnyParams& any) { fill_in(dynamic_cast<ParamsOf<Params>&>(any).value); };
  }

  FilePath world_, log_, ros_map_;
  std::map<std::string, std::function<void(AnyParams&)>> fillers_;
};

}  // namespace glocal::test
