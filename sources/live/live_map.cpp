#include "sources/live/live_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

#include "glocal/error.hpp"
#include "glocal/words.hpp"
#include "sources/bags/bag_map.hpp"
#include "sources/bags/cdr_writer.hpp"

namespace glocal::live {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds longest_wait{10};
constexpr std::chrono::milliseconds longest_look{100};
const char* const grid_type = "nav_msgs/OccupancyGrid";
const char* const place_of_faults = "the robot";

[[noreturn]] void fail(const std::string& message) {
  throw ConfigError(place_of_faults, message);
}

std::vector<std::string> maps_of(MessageLink& link) {
  std::vector<std::string> maps;
  for (const LiveTopic& topic : link.topics()) {
    if (topic.type == grid_type) maps.push_back(topic.name);
  }
  return maps;
}

[[noreturn]] void fail_without_map(MessageLink& link, const std::string& topic) {
  std::vector<std::string> there;
  for (const LiveTopic& other : link.topics()) there.push_back(other.name);
  fail(fmt::format("no map ({}) came {} within {} s; {}", grid_type,
                   topic.empty() ? "at all" : "on " + shown(topic), longest_wait.count(),
                   there.empty() ? "there are no topics: check the domain" : "there are " + listed(there)));
}

MapData map_in(const LiveMessage& message) {
  const bags::Connection connection{message.topic.name, grid_type, "cdr", ""};
  const auto grid =
      bags::read_occupancy_grid({&connection, message.stamp_ns, message.bytes, {.file = connection.topic}});
  return bags::map_of(grid, place_of_faults, message.topic.name);
}

/// Probability of being occupied; -1 is unknown.
std::int8_t percent_of(Cell cell) {
  constexpr std::int8_t unknown = -1, occupied = 100;
  if (cell == Cell::unknown) return unknown;
  return cell == Cell::occupied ? occupied : std::int8_t{0};
}

}  // namespace

void describe(ParamVisitor& v, LiveMap::Params& p) {
  v.strategy("link", p.link, *p.links, {.doc = "The way to the robot's messages.", .required = true});
  v.field("topic", p.topic,
          {.doc = "Topic with the map (nav_msgs/OccupancyGrid). Empty: the only one there is."});
}

MapData LiveMap::load() {
  return live_map(*params_.links->make(params_.link, setup_), params_.topic, setup_.is_stopped);
}

MapData live_map(MessageLink& link, std::string topic, const std::function<bool()>& is_stopped) {
  bool is_subscribed = false;
  for (const auto begun = Clock::now(); Clock::now() - begun < longest_wait && !is_stopped();) {
    const std::vector<std::string> maps = maps_of(link);
    if (topic.empty() && maps.size() > 1)
      fail(fmt::format("there are several maps; set topic to one of {}", listed(maps)));
    if (topic.empty() && maps.size() == 1) topic = maps.front();
    if (!topic.empty() && !is_subscribed) {
      link.subscribe({topic, grid_type}, Delivery::kept);
      is_subscribed = true;
    }
    const auto message = link.next(longest_look);
    if (message && message->topic.name == topic) return map_in(*message);
    if (!message && link.has_ended()) break;
  }
  fail_without_map(link, topic);
}

LiveMessage map_message(const MapData& map, std::string topic, const bags::Header& header) {
  if (map.grid.cells.empty()) {
    bags::PointCloud cloud{header, {}, {}};
    cloud.points.reserve(map.points.size());
    for (std::size_t i = 0; i < map.points.size(); ++i)
      cloud.points.push_back(as_point(as_vector(map.points[i]) + map.origin));
    return {{std::move(topic), "sensor_msgs/PointCloud2"}, header.stamp_ns, bags::serialized(cloud)};
  }
  bags::GridMessage grid{header,
                         map.grid.resolution,
                         static_cast<std::uint32_t>(map.grid.width),
                         static_cast<std::uint32_t>(map.grid.height),
                         shifted(Pose3(map.grid.map_from_grid), map.origin),
                         {}};
  std::transform(map.grid.cells.begin(), map.grid.cells.end(), std::back_inserter(grid.cells), percent_of);
  return {{std::move(topic), grid_type}, header.stamp_ns, bags::serialized(grid)};
}

}  // namespace glocal::live
