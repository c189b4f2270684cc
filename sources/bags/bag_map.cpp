#include "sources/bags/bag_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "glocal/error.hpp"
#include "glocal/words.hpp"
#include "sources/bags/recording.hpp"

namespace glocal::bags {
namespace {

/// Cells more likely to be occupied than this are: as map servers have it.
constexpr double occupied_thresh = 0.65;
/// Cells less likely to be occupied than this are free.
constexpr double free_thresh = 0.196;

constexpr const char* grid_type = "nav_msgs/OccupancyGrid";

[[noreturn]] void fail(const BagMap::Params& params, const std::string& message) {
  throw ConfigError(params.path.resolved, message);
}

std::string topic_of(const Recording& recording, const BagMap::Params& params) {
  std::set<std::string> topics;
  for (const Connection& connection : recording.connections()) {
    if (connection.type == grid_type) topics.insert(connection.topic);
  }
  if (topics.empty())
    fail(params, fmt::format("has no map ({}); glocal bag info shows what it has", grid_type));
  if (params.topic.empty() && topics.size() > 1)
    fail(params, fmt::format("has several maps; set topic to one of {}", listed(topics)));
  if (!params.topic.empty() && !topics.contains(params.topic))
    fail(params,
         fmt::format("has no map on {}; set topic to one of {}", shown(params.topic), listed(topics)));
  return params.topic.empty() ? *topics.begin() : params.topic;
}

GridMessage last_grid(Recording& recording, const std::string& topic, const BagMap::Params& params) {
  std::optional<GridMessage> last;
  recording.rewind(std::set{topic});
  while (const auto message = recording.next()) {
    if (message->connection->type == grid_type) last = read_occupancy_grid(*message);
  }
  if (!last) fail(params, fmt::format("has no message on {}", shown(topic)));
  return std::move(*last);
}

/// -1, and whatever else is no share, is unknown.
Cell cell_of(std::int8_t percent) {
  const double occupancy = percent / 100.0;
  if (percent < 0 || percent > 100) return Cell::unknown;
  if (occupancy > occupied_thresh) return Cell::occupied;
  return occupancy < free_thresh ? Cell::free : Cell::unknown;
}

}  // namespace

void describe(ParamVisitor& v, BagMap::Params& p) {
  v.field("path", p.path,
          {.doc = "ROS 1 bag, ROS 2 bag (.db3 or its folder) or MCAP file.",
           .required = true,
           .may_be_folder = true});
  v.field("strict", p.strict,
          {.doc = "Refuse a recording that is damaged behind something whole. Otherwise what is whole is "
                  "read, with a warning."});
  v.field("topic", p.topic,
          {.doc = "Topic with the map (nav_msgs/OccupancyGrid). Empty: the only one there is."});
}

MapData BagMap::load() {
  Recording recording(params_.path.resolved, damage_if(params_.strict));
  recording.tell_progress(setup_.progress);
  for (const auto& input : recording.inputs()) setup_.note_input(input);
  const std::string topic = topic_of(recording, params_);
  const GridMessage grid = last_grid(recording, topic, params_);
  for (const std::string& warning : recording.warnings()) setup_.warn(warning);
  return map_of(grid, params_.path.resolved.string(), topic);
}

MapData map_of(const GridMessage& grid, const std::string& source, const std::string& topic) {
  const std::string of_topic = "the map of " + shown(topic);
  const auto fail = [&](const std::string& message) { throw ConfigError(source, message); };
  if (static_cast<double>(grid.cells.size()) > max_grid_cells)
    fail(fmt::format("{} has {} x {} cells, more than {:g}; record it with a coarser resolution", of_topic,
                     grid.width, grid.height, max_grid_cells));
  constexpr double level = 1e-6;  // rad
  if (grid.frame_from_grid.tilt() > level)
    fail(of_topic + " is tilted against its frame; only level maps can be used");
  MapData map;
  const Vector3 corner = grid.frame_from_grid.translation();
  map.origin = origin_near({corner.x(), corner.y(), 0.0});
  map.grid = {seen_from_above(shifted(grid.frame_from_grid, -map.origin)), grid.resolution,
              static_cast<int>(grid.width), static_cast<int>(grid.height), PackedCells(grid.cells.size())};
  std::transform(grid.cells.begin(), grid.cells.end(), map.grid.cells.begin(), cell_of);
  map.points = occupied_centres(map.grid);
  if (map.points.empty()) fail(of_topic + " has no occupied cell, none above 65 %; take another topic");
  return map;
}

}  // namespace glocal::bags
