#include "app/localize_plan.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "app/drive_options.hpp"
#include "app/log_kind.hpp"
#include "config/experiment_params.hpp"
#include "config/products.hpp"
#include "config/scalars.hpp"
#include "config/writer.hpp"
#include "glocal/error.hpp"
#include "glocal/words.hpp"
#include "glocal/yaml.hpp"
#include "sources/bags/drive_contents.hpp"
#include "sources/bags/file_bytes.hpp"
#include "sources/bags/recording.hpp"
#include "sources/bags/recording_summary.hpp"
#include "sources/clouds/cloud_file.hpp"
#include "sources/clouds/cloud_formats.hpp"
#include "sources/compressed_file.hpp"
#include "sources/ros_map/ros_map.hpp"

namespace glocal::app {
namespace {

namespace fs = std::filesystem;

/// A name and its value, as lines of YAML.
std::string entry(const std::string& name, const std::string& value) {
  return fmt::format("{}: {}", name, to_yaml(std::string_view(value)));
}

std::string path_entry(const std::string& name, const fs::path& path) {
  return entry(name, fs::absolute(path).lexically_normal().string());
}

std::vector<std::string> strings_of(const std::vector<fs::path>& files) {
  return {files.begin(), files.end()};
}

/// How a map is read.
struct MapChoice {
  std::string yaml, text;
  bool in_space = false;
  double resolution = 0.0;  ///< m; 0 if not known.
};

bool is_file_of_octree(const fs::path& map) {
  if (fs::is_directory(map)) return false;
  const fs::path ending = map.extension();
  const bool is_packed = ending == ".gz" || ending == ".bz2" || ending == ".xz";
  return clouds::is_octree(is_packed ? read_decompressed(map, default_max_size_gb)
                                     : bags::FileBytes(map).peek(0));
}

/// The plugin knows of free voxels, too.
MapChoice choose_octree(const std::string& path, const Catalog& catalog) {
  if (catalog.map_sources.find("octomap") != nullptr)
    return {fmt::format("octomap: {{{}, points: space}}", path), "an octree", true};
  return {fmt::format("point_cloud: {{{}}}", path),
          "an octree, its occupied voxels only: the plugin octomap, which reads the free ones, is not loaded",
          true};
}

MapChoice choose_map(const fs::path& map, bool is_strict, const Catalog& catalog) {
  expect_there(map);
  const std::string path = path_entry("path", map);
  if (bags::is_recording(map))
    return {fmt::format("bag_map: {{{}{}}}", path, is_strict ? ", strict: true" : ""),
            "a map recorded as a message"};
  if (clouds::has_name_of_cloud(map))
    return {fmt::format("point_cloud: {{{}}}", path), "a cloud of points", true};
  if (is_file_of_octree(map)) return choose_octree(path, catalog);
  if (map.extension() != ".yaml" && map.extension() != ".yml")
    throw ConfigError(
        map,
        "is no map that is known: a map server's YAML, a cloud (PCD, PLY), an octree (.bt, .ot) or a "
        "recording with a nav_msgs/OccupancyGrid");
  ParamsOf<ros_map::RosMapFile> file;
  read_yaml(map, file);
  return {fmt::format("ros_map: {{{}}}", path),
          fmt::format("a map server's, cells of {} m", file.value.resolution), false, file.value.resolution};
}

/// What maps are called: by their files' names, or as they were given where two have the same.
std::vector<std::string> names_of(const std::string& first, const std::vector<fs::path>& others) {
  std::vector<std::string> names = {plain_name(first)}, given = {first};
  for (const fs::path& other : others) {
    names.push_back(plain_name(other));
    given.push_back(other.string());
  }
  const std::set<std::string> different(names.begin(), names.end());
  return different.size() == names.size() ? names : given;
}

/// `map`, which was given as `first`, and others beside it, as one.
MapChoice with_others(MapChoice map, const std::string& first, const std::vector<fs::path>& others,
                      bool is_strict, const Catalog& catalog) {
  if (others.empty()) return map;
  const std::vector<std::string> names = names_of(first, others);
  std::string maps;
  const auto add = [&](const std::string& name, const std::string& yaml) {
    maps += fmt::format("\n      - {{{}, source: {{{}}}}}", entry("name", name), yaml);
  };
  add(names[0], map.yaml);
  for (std::size_t i = 0; i < others.size(); ++i)
    add(names[i + 1], choose_map(others[i], is_strict, catalog).yaml);
  map.yaml = "several:\n    maps:" + maps;
  map.text = fmt::format("one of {}: {}", names.size(), fmt::join(names, ", "));
  return map;
}

/// How a log is read.
struct LogChoice {
  std::string yaml;
  std::vector<std::string> texts;
};

/// Lasers before clouds in the plane, clouds before lasers in space; then the widest view, and the most
/// beams. With those that have the same: robots with a laser at each end have two alike.
std::vector<std::string> choose_scans(const bags::RecordingSummary& summary, bool in_space) {
  const auto rank = [&](const bags::TopicSummary& topic) {
    const bool is_cloud = !topic.first_scan;
    const double view = is_cloud ? 0.0 : std::abs(topic.first_scan->angle_max - topic.first_scan->angle_min);
    const std::size_t beams = is_cloud ? 0 : topic.first_scan->ranges.size();
    return std::tuple(is_cloud == in_space, std::round(degrees(view)), beams);
  };
  std::vector<bags::TopicSummary> topics = summary.topics;
  std::erase_if(topics, [](const auto& t) { return !bags::has_scans(t.type) || t.messages == 0; });
  std::stable_sort(topics.begin(), topics.end(),
                   [&](const auto& a, const auto& b) { return rank(a) > rank(b); });
  std::vector<std::string> names;
  for (const bags::TopicSummary& topic : topics) {
    const bool is_best = rank(topic) == rank(topics.front());
    if (is_best && (names.empty() || topic.first_scan)) names.push_back(topic.topic);
  }
  return names;
}

std::vector<std::string> recording_texts(const bags::Recording& recording,
                                         const bags::RecordingSummary& summary,
                                         const bags::DriveContents& contents) {
  std::vector<std::string> texts = {
      fmt::format("log         {}, {:.1f} s, {:.1f} m", recording.format(),
                  static_cast<double>(summary.last_ns - summary.first_ns) * 1e-9, summary.path_m)};
  std::vector<std::string> scans;
  for (const bags::TopicSummary& topic : summary.topics) {
    if (!bags::has_scans(topic.type)) continue;
    const bool is_used = std::any_of(contents.scans.begin(), contents.scans.end(),
                                     [&](const auto& scan) { return scan.topic == topic.topic; });
    scans.push_back(fmt::format("{}{}", is_used ? "scans       " : "not used    ", text_of(topic)));
  }
  for (std::string& text : first_of(std::move(scans))) texts.push_back(std::move(text));
  texts.push_back(fmt::format("robot       {}, odometry {} from {}", shown(contents.base_frame),
                              contents.odometry.empty() ? "by tf" : "of " + shown(contents.odometry),
                              shown(contents.odom_frame)));
  return texts;
}

std::string recording_yaml(const LocalizeRequest& request, const bags::DriveContents& contents) {
  std::vector<std::string> scans;
  for (const bags::ScanTopic& scan : contents.scans) scans.push_back(to_yaml(std::string_view(scan.topic)));
  std::string yaml = fmt::format("bag:\n    {}\n    scans: [{}]\n    {}\n", path_entry("path", request.log),
                                 fmt::join(scans, ", "), entry("base_frame", contents.base_frame));
  yaml += fmt::format("    {}\n", contents.odometry.empty() ? entry("odom_frame", contents.odom_frame)
                                                            : entry("odometry", contents.odometry));
  if (request.strict) yaml += "    strict: true\n";
  return yaml;
}

LogChoice choose_recording(const LocalizeRequest& request, const MapChoice& map) {
  bags::Recording recording(request.log, bags::damage_if(request.strict));
  recording.tell_progress(request.progress);
  std::vector<std::string> told_by_the_source;
  const bags::RecordingSummary summary = bags::summarize_recording(recording, told_by_the_source);
  const bags::DriveTopics topics{
      .scans = request.scans.empty() ? choose_scans(summary, map.in_space) : request.scans,
      .odometry = request.odometry,
      .odom_frame = request.odom_frame,
      .base_frame = request.base_frame,
      .are_options = true};
  const bags::DriveContents contents =
      bags::read_contents(recording, topics, request.log.string(), [](const std::string&) {});
  LogChoice choice{recording_yaml(request, contents), recording_texts(recording, summary, contents)};
  if (contents.scans.front().are_clouds && !map.in_space) {
    choice.yaml += "    heights: [0.2, 1.5]\n";
    choice.texts.emplace_back("heights     0.2 m to 1.5 m of the clouds, above the robot's origin");
  }
  if (!request.reference.empty())
    choice.yaml += fmt::format("    reference: {{{}}}\n",
                               entry(is_topic(request.reference) ? "topic" : "frame", request.reference));
  return choice;
}

LogChoice choose_clouds(const LocalizeRequest& request) {
  refuse_topics_of_clouds(request.log, request.scans.empty() ? "" : request.scans.front(), request.odom_frame,
                          request.base_frame);
  LogChoice choice{fmt::format("cloud_drive:\n    {}\n", path_entry("folder", request.log)),
                   {"log         a folder of clouds"}};
  const fs::path odometry =
      request.odometry.empty() ? odometry_of_clouds(request.log) : fs::path(request.odometry);
  if (!odometry.empty()) {
    choice.yaml += fmt::format("    {}\n", path_entry("odometry", odometry));
    choice.texts.push_back(fmt::format("odometry    {}", odometry.filename().string()));
  }
  if (!request.reference.empty())
    choice.yaml += fmt::format("    {}\n", path_entry("reference", request.reference));
  return choice;
}

LogChoice choose_log(const LocalizeRequest& request, const MapChoice& map) {
  const LogKind kind = kind_of_log(request.log);
  if (kind == LogKind::recording) return choose_recording(request, map);
  if (kind == LogKind::clouds) return choose_clouds(request);
  if (!request.scans.empty() || !request.odometry.empty() || !request.odom_frame.empty() ||
      !request.base_frame.empty() || !request.reference.empty())
    throw ConfigError(
        request.log,
        "is taken for a CARMEN log, which has its scans, odometry and reference poses in itself: leave out "
        "--scans, --odometry, --odom-frame, --base-frame and --reference");
  return {fmt::format("carmen_log:\n    {}\n", path_entry("path", request.log)), {"log         CARMEN"}};
}

std::string trials_of(const LocalizeRequest& request) {
  if (request.whole) return "whole: true";
  const std::string where = request.every_m > 0.0 ? fmt::format("every_m: {}", request.every_m)
                                                  : fmt::format("starts_m: [{}]", request.start_m);
  return where + ", max_steps: 200";
}

/// The value of localizer.prior.
std::string prior_yaml(const Prior& prior) {
  std::vector<std::string> keys;
  const StartRegion& region = prior.region;
  if (region.is_given())
    keys.push_back(fmt::format("region: {{x: {}, y: {}, radius: {}}}", *region.x, *region.y, *region.radius));
  const StartHeading& heading = prior.heading;
  if (heading.is_given())
    keys.push_back(fmt::format("heading: {{deg: {}, width_deg: {}}}", *heading.deg, *heading.width_deg));
  return fmt::format("{{{}}}", fmt::join(keys, ", "));
}

/// Plans and sensors are off by centimetres, however fine a map's cells are.
void widen_contact(const MapChoice& map, LocalizePlan& plan, std::map<std::string, std::string>& changes) {
  constexpr double finest = 0.05, least_epsilon = 0.1;  // m
  if (map.resolution == 0.0 || map.resolution >= finest) return;
  plan.choices.push_back(fmt::format(
      "contact     within {} m: the map's cells are finer than maps and sensors are true", least_epsilon));
  changes["contact_epsilon"] = fmt::format("{}", least_epsilon);
}

/// The way to the robot's messages, as YAML.
std::string link_yaml(const LiveRequest& request) {
  if (request.recording.empty())
    return request.domain ? fmt::format("{{ros2: {{domain: {}}}}}", *request.domain) : "ros2";
  return fmt::format("{{recording: {{{}, in_real_time: {}}}}}", path_entry("path", request.recording),
                     request.in_real_time);
}

MapChoice choose_live_map(const LiveRequest& request, const Catalog& catalog) {
  constexpr std::string_view topic = "topic:";
  if (!request.map.starts_with(topic))
    return with_others(choose_map(request.map, false, catalog), request.map, request.more_maps, false,
                       catalog);
  const MapChoice sent = {fmt::format("ros2_map: {{link: {}, {}}}", link_yaml(request),
                                      entry("topic", request.map.substr(topic.size()))),
                          "what the robot's map server sends"};
  return with_others(sent, "map", request.more_maps, false, catalog);
}

std::string live_drive_yaml(const LiveRequest& request) {
  std::string yaml = fmt::format("ros2:\n    link: {}\n", link_yaml(request));
  for (const auto& [key, value] :
       {std::pair("scans", &request.scans), std::pair("odometry", &request.odometry),
        std::pair("odom_frame", &request.odom_frame), std::pair("base_frame", &request.base_frame),
        std::pair("namespace", &request.name_space)}) {
    if (!value->empty()) yaml += fmt::format("    {}\n", entry(key, *value));
  }
  if (!request.heights.empty()) yaml += fmt::format("    heights: [{}]\n", fmt::join(request.heights, ", "));
  return yaml;
}

/// Whether a method sets this key of the localizer.
bool is_set(const std::string& method, const std::string& key, const Catalog& catalog) {
  ExperimentFileParams params(catalog);
  const YamlNode keys = read_method(method, params);
  return find_entry(find_entry(keys, "localizer")->value, key) != nullptr;
}

}  // namespace

LocalizePlan plan_live(const LiveRequest& request, const Catalog& catalog) {
  const MapChoice map = choose_live_map(request, catalog);
  LocalizePlan plan{.name = "live", .experiment = {}, .choices = {"map         " + map.text}};
  std::map<std::string, std::string> changes;
  widen_contact(map, plan, changes);
  const std::string method = request.method.empty() ? default_method(map.in_space) : request.method;
  plan.choices.push_back(fmt::format("method      {}", shown(method)));
  const bool is_recorded = !request.recording.empty() && !request.in_real_time;
  if (is_recorded)
    changes["looks_per_step"] = "0";
  else if (!is_set(method, "looks_per_step", catalog))
    changes["looks_per_step"] = fmt::format("{}", looks_of_piece);
  std::vector<std::string> plugins = strings_of(request.plugins);
  if (request.recording.empty()) plugins.emplace_back("plugin:ros2");
  plan.experiment = fmt::format(
      "# Written by glocal live.\n"
      "schema: 1\n"
      "name: live\n"
      "seed: 1\n"
      "map:\n"
      "  {}\n"
      "observations:\n"
      "  {}"
      "trials: {{whole: true}}\n"
      "{}",
      map.yaml, live_drive_yaml(request), localizer_yaml(method, changes, catalog, plugins));
  return plan;
}

LocalizePlan plan_localization(const LocalizeRequest& request, const Catalog& catalog) {
  const MapChoice map = with_others(choose_map(request.map, request.strict, catalog), request.map.string(),
                                    request.more_maps, request.strict, catalog);
  const LogChoice log = choose_log(request, map);
  LocalizePlan plan{.name = "localize_" + plain_name(request.log),
                    .experiment = {},
                    .choices = {"map         " + map.text}};
  plan.choices.insert(plan.choices.end(), log.texts.begin(), log.texts.end());
  std::map<std::string, std::string> changes;
  widen_contact(map, plan, changes);
  const std::string method = request.method.empty() ? default_method(map.in_space) : request.method;
  plan.choices.push_back(fmt::format("method      {}", shown(method)));
  if (request.prior.is_given()) {
    plan.choices.push_back(fmt::format("prior       only {}", to_string(request.prior)));
    changes["prior"] = prior_yaml(request.prior);
  }
  plan.experiment = fmt::format(
      "# Written by glocal localize.\n"
      "schema: 1\n"
      "{}\n"
      "seed: 1\n"
      "map:\n"
      "  {}\n"
      "observations:\n"
      "  {}"
      "trials: {{{}}}\n"
      "{}",
      entry("name", plan.name), map.yaml, log.yaml, trials_of(request),
      localizer_yaml(method, changes, catalog, strings_of(request.plugins)));
  return plan;
}

std::string localizer_yaml(const std::string& method, const std::map<std::string, std::string>& changes,
                           const Catalog& catalog, std::vector<std::string> plugins) {
  ExperimentFileParams params(catalog);
  const YamlNode keys = read_method(method, params);
  std::string yaml = fmt::format("# The method {}.\n", method);
  if (const YamlEntry* of_method = find_entry(keys, "plugins")) {
    for (const YamlNode& plugin : of_method->value.items) {
      const bool is_relative = !plugin.text.starts_with("plugin:");
      plugins.push_back(is_relative ? fs::absolute(plugin.place.origin->folder / plugin.text).string()
                                    : plugin.text);
    }
  }
  for (std::string& plugin : plugins) plugin = to_yaml(std::string_view(plugin));
  if (!plugins.empty()) yaml += fmt::format("plugins: [{}]\n", fmt::join(plugins, ", "));
  yaml += "localizer:\n";
  for (const YamlEntry& entry : find_entry(keys, "localizer")->value.entries) {
    if (!changes.contains(entry.key)) yaml += fmt::format("  {}: {}\n", entry.key, flow_yaml(entry.value));
  }
  for (const auto& [key, value] : changes) yaml += fmt::format("  {}: {}\n", key, value);
  return yaml;
}

}  // namespace glocal::app
