// From a map and a log to an experiment: what `glocal localize` chooses by itself.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "glocal/catalog.hpp"
#include "glocal/prior.hpp"

namespace glocal::app {

/// Of searches at a time, where a robot drives on meanwhile: some 30 ms.
constexpr std::size_t looks_of_piece = 3'000'000;

/// What is to be localized, and from where on. At most one of every_m and whole is given.
struct LocalizeRequest {
  std::filesystem::path map, log;
  std::vector<std::filesystem::path> more_maps;  ///< Other floors: the robot is on any of them.
  std::vector<std::string> scans;                ///< Topics of a recording; empty: chosen.
  std::string odometry;                ///< Of a recording: topic. Of a folder of clouds: file of poses.
  std::string odom_frame, base_frame;  ///< Of a recording's tf; empty: the usual ones.
  std::string reference;  ///< Of a recording: topic or frame of tf. Of a folder of clouds: file of poses.
  double start_m = 0.0;   ///< Along the drive.
  double every_m = 0.0;   ///< Way between starts; 0: a single one.
  bool strict = false;    ///< Refuses recordings that are damaged in part.
  std::string method;     ///< Name or file; empty: one that fits the map.
  bool whole = false;     ///< Goes on after the declaration, to the end of the drive.
  Prior prior;            ///< Of each start.
  std::vector<std::filesystem::path> plugins;  ///< Files, which the experiment is to name.
  TellProgress progress = [](double) {};
};

struct LocalizePlan {
  std::string name;                  ///< Fit for a folder.
  std::string experiment;            ///< YAML, with absolute paths.
  std::vector<std::string> choices;  ///< What was chosen, "scans: /front, the widest view".
};

/// Looks into both, and decides by their content: map server's YAML, cloud, octree or recording; recording,
/// CARMEN log or folder of clouds. An octree needs its plugin in `catalog` for its free voxels. Throws
/// ConfigError for what is none of these, and where a reader does.
[[nodiscard]] LocalizePlan plan_localization(const LocalizeRequest& request, const Catalog& catalog);

/// A robot that is to be localized while it drives.
struct LiveRequest {
  /// Map server's YAML, cloud, octree or recording; `topic:/map`: what a map server sends; `topic:` alone the
  /// only such topic.
  std::string map;
  std::vector<std::filesystem::path> more_maps;
  std::filesystem::path recording;     ///< In place of the robot; empty: DDS.
  bool in_real_time = false;           ///< The recording's messages come when they came to the recorder.
  std::optional<int> domain;           ///< Of DDS; none: ROS_DOMAIN_ID, else 0.
  std::string scans, odometry;         ///< Topics; empty: the only one there is.
  std::string odom_frame, base_frame;  ///< Of tf; empty: the usual ones.
  std::string name_space;              ///< Of the robot's topics.
  std::vector<double> heights;         ///< m; of clouds.
  std::string method;                  ///< Name or file; empty: one that fits the map.
  std::vector<std::filesystem::path> plugins;  ///< Files, which the experiment is to name.
};

/// The same for a robot that drives. Its trials are a single one that does not end.
[[nodiscard]] LocalizePlan plan_live(const LiveRequest& request, const Catalog& catalog);

/// The built-in method that fits most robots and maps.
[[nodiscard]] inline const char* default_method(bool in_space) {
  return in_space ? "lidar_upright" : "indexed";
}

/// The localizer's part of an experiment, and the plugins it needs, as a method (name or file) has it;
/// `changes`: values in YAML, by key, that take the place of the method's; `plugins`: more that are needed.
/// Throws ConfigError.
[[nodiscard]] std::string localizer_yaml(const std::string& method,
                                         const std::map<std::string, std::string>& changes,
                                         const Catalog& catalog, std::vector<std::string> plugins = {});

}  // namespace glocal::app
