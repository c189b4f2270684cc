#include "sources/register.hpp"

#include "sources/bags/bag_drive.hpp"
#include "sources/bags/bag_map.hpp"
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

namespace glocal {

void register_sources(Catalog& catalog) {
  catalog.observation_sources.add<bags::BagDrive>("bag", "A drive recorded by a robot: ROS bag or MCAP.",
                                                  stable_since("0.1.0"));
  catalog.observation_sources.add<carmen::CarmenLog>("carmen_log", "A drive recorded as a CARMEN log.",
                                                     stable_since("0.1.0"));
  catalog.observation_sources.add<clouds::CloudDrive>("cloud_drive", "A drive recorded as clouds of points.",
                                                      stable_since("0.1.0"));
  catalog.observation_sources.add<clouds::CloudPairScan>(
      "cloud_pair", "The source of a pair of clouds from a list.", experimental_since("0.1.0"));
  catalog.observation_sources.add<simulation::Simulation>(
      "simulation", "A drive through a simulated world, or through a ROS map, with a planar laser.",
      stable_since("0.1.0"));
  catalog.observation_sources.add<simulation::LidarSimulation>(
      "lidar_simulation", "A drive through a simulated world with a lidar.", stable_since("0.1.0"));
  catalog.observation_sources.add<sites::OfficeDrive>(
      "office", "A drive through a simulated office of any size.", stable_since("0.1.0"));
  catalog.observation_sources.add<simulation::RandomScans>(
      "random_scans", "Single scans at random places of a ROS map.", experimental_since("0.1.0"));
  catalog.observation_sources.add<disturbed::DisturbedDrive>(
      "disturbed", "Another source, with what goes wrong on real robots.", experimental_since("0.1.0"),
      {.sources = &catalog.observation_sources});
  catalog.observation_sources.add<several::SeveralDrives>(
      "several", "Drives on several maps, one after the other.", experimental_since("0.1.0"),
      {.sources = &catalog.observation_sources});
  catalog.map_sources.add<bags::BagMap>("bag_map", "A map recorded as a message: ROS bag or MCAP.",
                                        experimental_since("0.1.0"));
  catalog.map_sources.add<carmen::LogMap>("log_map", "A map from the reference poses of a CARMEN log.",
                                          stable_since("0.1.0"));
  catalog.map_sources.add<clouds::CloudDriveMap>(
      "cloud_drive", "A map in space from the reference poses of a drive of clouds.", stable_since("0.1.0"));
  catalog.map_sources.add<clouds::CloudPairMap>("cloud_pair", "The target of a pair of clouds from a list.",
                                                experimental_since("0.1.0"));
  catalog.map_sources.add<ros_map::RosMap>(
      "ros_map", "A map of the ROS map server: a YAML file and an image.", stable_since("0.1.0"));
  catalog.map_sources.add<clouds::PointCloudMap>(
      "point_cloud", "A cloud of points: PCD, PLY, KITTI, or OctoMap's .bt.", stable_since("0.1.0"));
  catalog.map_sources.add<simulation::SimulatedMap>("simulation", "The map of a simulated world.",
                                                    stable_since("0.1.0"));
  catalog.map_sources.add<disturbed::DisturbedMap>(
      "disturbed", "Another map, with what has changed in the world since it was made.",
      experimental_since("0.1.0"), {.sources = &catalog.map_sources});
  catalog.map_sources.add<several::SeveralMaps>(
      "several", "Maps side by side, as the floors of a building: the robot is on one of them.",
      experimental_since("0.1.0"), {.sources = &catalog.map_sources});
  catalog.map_sources.add<sites::OfficeMap>("office", "The map of a simulated office of any size.",
                                            stable_since("0.1.0"));
  catalog.message_links.add<live::RecordingLink>("recording", "A recording in place of a robot.",
                                                 experimental_since("0.1.0"));
  catalog.observation_sources.add<live::LiveDrive>("ros2", "The drive of a robot while it drives.",
                                                   experimental_since("0.1.0"),
                                                   {.links = &catalog.message_links});
  catalog.map_sources.add<live::LiveMap>("ros2_map", "The map that a robot's map server sends.",
                                         experimental_since("0.1.0"), {.links = &catalog.message_links});
}

}  // namespace glocal
