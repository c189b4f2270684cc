// glocal bag: look at robots' own recordings.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/drive_options.hpp"
#include "app/reading_bar.hpp"
#include "app/standard_streams.hpp"
#include "evaluation/results/json_text.hpp"
#include "glocal/pose2.hpp"
#include "glocal/words.hpp"
#include "sources/bags/recording_summary.hpp"
#include "sources/bags/scan_placer.hpp"

namespace glocal::app {
namespace {

using Json = nlohmann::ordered_json;

struct BagOptions {
  std::string file;
  bool json = false, strict = false;
};

/// Of more topics, or frames, than anybody reads the rest is counted.
constexpr std::size_t most_lines = 1000;

void show_topics(const std::vector<bags::TopicSummary>& topics) {
  const std::size_t n = std::min(topics.size(), most_lines);
  std::size_t topic_width = 0, type_width = 0;
  for (std::size_t i = 0; i < n; ++i) {
    topic_width = std::max(topic_width, shown(topics[i].topic).size());
    type_width = std::max(type_width, shown(topics[i].type).size());
  }
  answer("topics\n");
  for (std::size_t i = 0; i < n; ++i) {
    const bags::TopicSummary& topic = topics[i];
    answer("  {:{}}  {:{}} {:8} {:8.2f} Hz  {}\n", shown(topic.topic), topic_width, shown(topic.type),
           type_width, topic.messages, topic.rate_hz(), listed(topic.frames, " "));
    if (topic.first_scan) answer("  {:{}}  {}\n", "", topic_width, text_of(*topic.first_scan));
  }
  if (n < topics.size()) answer("  and {} more; --json has all\n", topics.size() - n);
}

void show(const bags::Recording& recording, const bags::RecordingSummary& summary) {
  answer("format      {}\n", recording.format());
  answer("messages    {}\n", summary.messages);
  answer("time        {:.3f} s, from {:.3f} s on\n", bags::seconds(summary.last_ns - summary.first_ns),
         bags::seconds(summary.first_ns));
  if (!summary.odometry.empty())
    answer("path        {:.2f} m by {}\n", summary.path_m, shown(summary.odometry));
  show_topics(summary.topics);
  if (!summary.parents.empty()) answer("frames\n{}", bags::frame_tree(summary.parents, most_lines));
}

Json json_of(const bags::TopicSummary& topic) {
  Json json = {{"topic", topic.topic},
               {"type", topic.type},
               {"encoding", topic.encoding},
               {"messages", topic.messages},
               {"rate_hz", topic.rate_hz()},
               {"first_s", bags::seconds(topic.first_ns)},
               {"last_s", bags::seconds(topic.last_ns)},
               {"frames", topic.frames},
               {"unreadable", topic.unreadable}};
  if (topic.first_scan) {
    const bags::LaserScan& scan = *topic.first_scan;
    json["scan"] = {{"beams", scan.ranges.size()},
                    {"angle_deg", degrees(scan.angle_max - scan.angle_min)},
                    {"range_min_m", scan.range_min},
                    {"range_max_m", scan.range_max}};
  }
  return json;
}

Json json_of(const bags::Recording& recording, const bags::RecordingSummary& summary) {
  Json json = {{"format", recording.format()},
               {"messages", summary.messages},
               {"first_s", bags::seconds(summary.first_ns)},
               {"last_s", bags::seconds(summary.last_ns)},
               {"odometry", summary.odometry},
               {"path_m", summary.path_m},
               {"topics", Json::array()},
               {"parents", summary.parents}};
  for (const bags::TopicSummary& topic : summary.topics) json["topics"].push_back(json_of(topic));
  return json;
}

void info(const BagOptions& options) {
  ReadingBar bar;
  bags::Recording recording(options.file, bags::damage_if(options.strict));
  recording.tell_progress(bar.call());
  std::vector<std::string> remarks;
  const bags::RecordingSummary summary = bags::summarize_recording(recording, remarks);
  for (const std::string& warning : recording.warnings()) spdlog::warn("{}", warning);
  for (const std::string& remark : remarks) spdlog::warn("{}", remark);
  if (!options.json) return show(recording, summary);
  answer("{}\n", json_text(json_of(recording, summary), 2));
}

}  // namespace

void add_bag(CLI::App& app, Context& /*context*/) {
  auto options = std::make_shared<BagOptions>();
  CLI::App* bag = app.add_subcommand("bag", "Look at robots' own recordings: ROS bags and MCAP.");
  bag->require_subcommand(1);
  CLI::App* info_command =
      bag->add_subcommand("info", "Show topics, rates, frames, scans and the way driven.");
  info_command->add_option("FILE", options->file, "ROS 1 bag, ROS 2 bag (.db3 or its folder) or MCAP")
      ->required();
  info_command->add_flag("--json", options->json, "As JSON");
  add_strict(*info_command, options->strict);
  info_command->callback([options] { info(*options); });
}

}  // namespace glocal::app
