#include "sources/ros_map/ros_map.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "glocal/error.hpp"
#include "glocal/limits.hpp"
#include "glocal/yaml.hpp"
#include "sources/ros_map/image.hpp"

namespace glocal::ros_map {
namespace {

/// What map savers paint unknown cells with. Its darkness of 0.19608 lies below some files' free_thresh of
/// 0.25, which would make everything unknown free.
constexpr float saved_unknown = 205.0F;

std::string in_small_letters(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

bool is_mode(const std::string& mode) {
  return mode == "trinary" || mode == "scale" || mode == "raw";
}

bool is_saved_unknown(float grey) {
  return std::round(grey * 255.0F) == saved_unknown;
}

Cell by_thresholds(double occupancy, const RosMapFile& file) {
  if (occupancy > file.occupied_thresh) return Cell::occupied;
  return occupancy < file.free_thresh ? Cell::free : Cell::unknown;
}

bool is_negated(const RosMapFile& file) {
  return file.negate == "1" || file.negate == "true";
}

double occupancy(double brightness, const RosMapFile& file) {
  return is_negated(file) ? brightness : 1.0 - brightness;
}

/// An alpha channel counts as a fourth colour.
Cell trinary(float grey, const float* opacity, const RosMapFile& file) {
  if (!is_negated(file) && is_saved_unknown(grey)) return Cell::unknown;
  const double brightness = opacity == nullptr ? grey : (3.0 * grey + *opacity) / 4.0;
  return by_thresholds(occupancy(brightness, file), file);
}

/// What is not quite opaque is unknown.
Cell scale(float grey, const float* opacity, const RosMapFile& file) {
  if (opacity != nullptr && *opacity < 1.0F) return Cell::unknown;
  return by_thresholds(occupancy(grey, file), file);
}

/// Byte values up to 100 are per cent of occupancy, all others unknown.
Cell raw(float grey, const RosMapFile& file) {
  const double percent = std::round(grey * 255.0);
  return percent > 100.0 ? Cell::unknown : by_thresholds(percent / 100.0, file);
}

Cell classify(const ImageRow& row, std::size_t i, const RosMapFile& file) {
  const float* opacity = row.opacity.empty() ? nullptr : &row.opacity[i];
  if (file.mode == "raw") return raw(row.grey[i], file);
  return file.mode == "scale" ? scale(row.grey[i], opacity, file) : trinary(row.grey[i], opacity, file);
}

/// As most are as their neighbour is.
bool is_same_pixel(const ImageRow& row, std::size_t a, std::size_t b) {
  return row.grey[a] == row.grey[b] && (row.opacity.empty() || row.opacity[a] == row.opacity[b]);
}

/// Its corner is at the file's origin less that of the map.
OccupancyGrid grid_of(const RosMapFile& file, const Vector3& origin) {
  const Pose2 corner{file.origin[0] - origin.x(), file.origin[1] - origin.y(), wrap_angle(file.origin[2])};
  OccupancyGrid grid{corner, file.resolution, 0, 0, {}};
  const auto take = [&](const ImageRow& row) {
    if (row.row == 0) {
      grid.width = row.width;
      grid.height = row.height;
      grid.cells = PackedCells(static_cast<std::size_t>(row.width) * static_cast<std::size_t>(row.height));
    }
    const std::size_t begin = grid.index(0, grid.height - 1 - row.row);
    for (std::size_t i = 0, end = 0; i < row.grey.size(); i = end) {
      for (end = i + 1; end < row.grey.size() && is_same_pixel(row, end, i);) ++end;
      grid.cells.fill(begin + i, end - i, classify(row, i, file));
    }
  };
  read_image(file.image.resolved, take);
  return grid;
}

}  // namespace

void describe(ParamVisitor& v, RosMapFile& p) {
  v.field("image", p.image, {.doc = "PGM or PNG image; its lowest row is the lowest y.", .required = true});
  v.field("resolution", p.resolution,
          {.doc = "Side of a pixel.",
           .unit = "m",
           .min = least_resolution,
           .max = largest_resolution,
           .required = true});
  v.field("origin", p.origin,
          {.doc = "Pose of the lower left pixel's corner: x, y (m), yaw (rad).",
           .min = -farthest_m,
           .max = farthest_m,
           .min_items = 3,
           .max_items = 3,
           .may_be_nan = true,
           .required = true});
  v.field("negate", p.negate,
          {.doc = "1 or true: light means occupied.", .choices = {"0", "1", "false", "true"}});
  v.field("occupied_thresh", p.occupied_thresh,
          {.doc = "Darker than this is occupied.", .min = 0.0, .max = 1.0});
  v.field("free_thresh", p.free_thresh, {.doc = "Lighter than this is free.", .min = 0.0, .max = 1.0});
  v.field("mode", p.mode, {.doc = "How pixels become cells: trinary, scale or raw, in letters of any case."});
  v.require(p.origin.size() != 3 || std::isfinite(p.origin[0] + p.origin[1]), "origin",
            "must begin with two finite numbers, x and y");
  v.require(p.free_thresh <= p.occupied_thresh, "free_thresh", "must not be above occupied_thresh");
  v.require(is_mode(in_small_letters(p.mode)), "mode", "must be trinary, scale or raw");
}

void describe(ParamVisitor& v, RosMap::Params& p) {
  v.field("path", p.path, {.doc = "YAML file of a ROS map server.", .required = true});
}

RosMap::RosMap(const Params& params, const SourceSetup& setup) : name_(params.path.resolved.string()) {
  ParamsOf<RosMapFile> file;
  read_yaml(params.path.resolved, file);
  file_ = std::move(file.value);
  file_.mode = in_small_letters(file_.mode);
  // There are tools that write it for maps that are not turned, and map servers take it for that.
  double& yaw = file_.origin[2];
  if (std::isnan(yaw)) {
    setup.warn(fmt::format("{}: the origin's yaw is NaN, and is taken as 0", name_));
    yaw = 0.0;
  }
  setup.note_input(params.path.resolved);
  setup.note_input(file_.image.resolved);
}

MapData RosMap::load() {
  MapData map;
  map.origin = origin_near({file_.origin[0], file_.origin[1], 0.0});
  map.grid = grid_of(file_, map.origin);
  map.points = occupied_centres(map.grid);
  if (map.points.empty()) {
    throw ConfigError(
        name_,
        "its image has no occupied cell; check negate, occupied_thresh and mode, or take another image");
  }
  return map;
}

}  // namespace glocal::ros_map
