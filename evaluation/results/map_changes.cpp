#include "evaluation/results/map_changes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "config/text_file.hpp"
#include "evaluation/results/file_io.hpp"
#include "glocal/error.hpp"
#include "glocal/pose_tolerance.hpp"

namespace glocal {
namespace {

constexpr double wide_side = 0.2;     // m
constexpr double least_off = 0.25;    // m from all of the map; hits nearer may be of its walls
constexpr double wall = 0.1;          // m around a hit that may be of the same wall
constexpr double least_behind = 0.3;  // m that a ray goes on behind what it has passed
constexpr std::uint32_t least_views = 3;
/// Poses of views of their own.
constexpr PoseTolerance same_view{.translation = 0.1, .rotation = radians(5.0)};

constexpr std::array list_keys = {"new", "gone"};
constexpr std::array box_keys = {"x", "y", "width", "height", "views"};

Pose2 place_of(const Point& p, const Pose2& map_from_robot) {
  return map_from_robot * Pose2{p.x, p.y, 0.0};
}

std::pair<int, int> square_of(const Pose2& grid_from_place, double side) {
  return {static_cast<int>(std::floor(grid_from_place.x / side)),
          static_cast<int>(std::floor(grid_from_place.y / side))};
}

/// Shares of a segment's length; nothing if `high` is below `low`.
struct Part {
  double low = 0.0, high = 1.0;
};

/// What of a segment, m in the grid's frame, lies in the grid or less than a square beside it.
Part part_inside(const OccupancyGrid& grid, const Pose2& from, const Pose2& to) {
  Part inside;
  const auto clip = [&](double begin, double end, int cells) {
    const double low = -wide_side;
    const double high = cells * grid.resolution + wide_side;
    const double way = end - begin;
    if (way == 0.0 && (begin < low || begin > high)) inside.high = -1.0;
    if (way == 0.0) return;
    inside.low = std::max(inside.low, ((way > 0.0 ? low : high) - begin) / way);
    inside.high = std::min(inside.high, ((way > 0.0 ? high : low) - begin) / way);
  };
  clip(from.x, to.x, grid.width);
  clip(from.y, to.y, grid.height);
  return inside;
}

nlohmann::ordered_json json_of(const std::vector<MapChange>& changes, const Vector3& origin) {
  auto list = nlohmann::ordered_json::array();
  for (const MapChange& change : changes) {
    list.push_back({{"x", change.x + origin.x()},
                    {"y", change.y + origin.y()},
                    {"width", change.width},
                    {"height", change.height},
                    {"views", change.views}});
  }
  return list;
}

bool are_changes(const nlohmann::ordered_json& json) {
  const auto is_box = [](const nlohmann::ordered_json& change) {
    return std::all_of(box_keys.begin(), box_keys.end(), [&](const char* key) {
      return change.is_object() && change.contains(key) && change[key].is_number();
    });
  };
  return std::all_of(list_keys.begin(), list_keys.end(), [&](const char* key) {
    return json.is_object() && json.contains(key) && json[key].is_array() &&
           std::all_of(json[key].begin(), json[key].end(), is_box);
  });
}

}  // namespace

MapChanges::MapChanges(const GlobalMap& map) : map_(map), distances_(distance_field(map, 1)) {}

void MapChanges::add(const Scan& scan, const Pose2& map_from_robot) {
  if (last_ && same_view.are_near(map_from_robot, *last_)) return;
  last_ = map_from_robot;
  const Pose2 sensor = place_of(scan.origin, map_from_robot);
  Seen wide, cells;
  for (const Points* ends : {&scan.hits, &scan.free_ends}) {
    for (std::size_t i = 0; i < ends->size(); ++i)
      follow(sensor, place_of((*ends)[i], map_from_robot), wide, cells);
  }
  for (std::size_t i = 0; i < scan.hits.size(); ++i)
    add_hit(place_of(scan.hits[i], map_from_robot), wide, cells);
  wide.add_to(wide_);
  cells.add_to(cells_);
}

void MapChanges::Seen::add_to(Squares& squares) const {
  for (const Square& square : hit) ++squares[square].hits;
  for (const Square& square : passed) squares[square].passes += hit.contains(square) ? 0 : 1;
}

/// Notes all that a ray passes.
void MapChanges::follow(const Pose2& from, const Pose2& to, Seen& wide, Seen& cells) const {
  const OccupancyGrid& grid = map_.grid();
  const Pose2 grid_from_map = inverse(grid.map_from_grid);
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  const double step = grid.resolution / 2.0;
  // What the grid does not have is no change: rays may go on for kilometres behind it.
  const Part inside = part_inside(grid, grid_from_map * from, grid_from_map * to);
  std::optional<Square> last;
  const double end = std::min(length - least_behind, inside.high * length);
  for (double along = step * std::floor(inside.low * length / step); along < end; along += step) {
    const double share = along / length;
    const Pose2 place{from.x + share * (to.x - from.x), from.y + share * (to.y - from.y), 0.0};
    const Square square = square_of(place, wide_side);
    if (square != last) wide.passed.insert(square);
    last = square;
    if (grid.at(place.x, place.y) == Cell::occupied)
      cells.passed.insert(square_of(grid_from_map * place, grid.resolution));
  }
}

/// A hit speaks for what the map has around it, and for something new where that is far away.
void MapChanges::add_hit(const Pose2& hit, Seen& wide, Seen& cells) const {
  const OccupancyGrid& grid = map_.grid();
  const Pose2 grid_from_map = inverse(grid.map_from_grid);
  const auto [column, row] = square_of(grid_from_map * hit, grid.resolution);
  const int around = static_cast<int>(std::ceil(wall / grid.resolution));
  for (int y = std::max(row - around, 0); y <= std::min(row + around, grid.height - 1); ++y) {
    for (int x = std::max(column - around, 0); x <= std::min(column + around, grid.width - 1); ++x) {
      if (grid.cell(x, y) == Cell::occupied) cells.hit.emplace(x, y);
    }
  }
  const float off = distances_->at(static_cast<float>(hit.x), static_cast<float>(hit.y)).distance;
  if (off >= least_off && grid.at(hit.x, hit.y) == Cell::free) wide.hit.insert(square_of(hit, wide_side));
}

template <class IsChanged>
std::vector<MapChange> MapChanges::groups(const Squares& squares, double side, std::size_t least,
                                          IsChanged is_changed) const {
  std::set<Square> left;
  for (const auto& [square, views] : squares) {
    if (is_changed(views)) left.insert(square);
  }
  std::vector<MapChange> changes;
  while (!left.empty()) {
    std::vector<Square> group{*left.begin()};
    left.erase(left.begin());
    for (std::size_t i = 0; i < group.size(); ++i) {
      const auto [column, row] = group[i];
      for (const int y : {row - 1, row, row + 1}) {
        for (const int x : {column - 1, column, column + 1}) {
          if (left.erase({x, y}) > 0) group.emplace_back(x, y);
        }
      }
    }
    if (group.size() < least) continue;
    const auto [west, east] = std::ranges::minmax_element(group);
    const auto [south, north] = std::ranges::minmax_element(group, {}, &Square::second);
    MapChange change{.x = side * (west->first + east->first + 1) / 2.0,
                     .y = side * (south->second + north->second + 1) / 2.0,
                     .width = side * (east->first - west->first + 1),
                     .height = side * (north->second - south->second + 1)};
    for (const Square& square : group) {
      const Views& views = squares.at(square);
      change.views = std::max<std::size_t>({change.views, views.hits, views.passes});
    }
    changes.push_back(change);
  }
  return changes;
}

std::vector<MapChange> MapChanges::brought() const {
  return groups(wide_, wide_side, 1,
                [](const Views& views) { return views.hits >= least_views && views.hits > views.passes; });
}

std::vector<MapChange> MapChanges::taken() const {
  constexpr std::size_t least_cells = 3;
  constexpr std::uint32_t passes_for_a_hit = 4;
  std::vector<MapChange> changes =
      groups(cells_, map_.grid().resolution, least_cells, [](const Views& views) {
        return views.passes >= least_views && views.passes > passes_for_a_hit * views.hits;
      });
  const Pose2& map_from_grid = map_.grid().map_from_grid;
  for (MapChange& change : changes) {
    const Pose2 middle = map_from_grid * Pose2{change.x, change.y, 0.0};
    const double c = std::abs(std::cos(map_from_grid.theta)), s = std::abs(std::sin(map_from_grid.theta));
    change = {.x = middle.x,
              .y = middle.y,
              .width = c * change.width + s * change.height,
              .height = s * change.width + c * change.height,
              .views = change.views};
  }
  return changes;
}

std::string changes_file(std::size_t trial) {
  return fmt::format("maps/trial_{:04}/changes.json", trial);
}

nlohmann::ordered_json read_changes(const std::filesystem::path& file) {
  const auto refuse = [&](const char* what) {
    throw ConfigError(file, fmt::format("{}; run the experiment again", what));
  };
  if (why_unreadable(file)) refuse("cannot be read");
  auto json = nlohmann::ordered_json::parse(content_of(file), nullptr, false);
  if (!are_changes(json))
    refuse("has no changes as glocal run leaves them (new, gone: x, y, width, height, views)");
  return json;
}

std::optional<std::string> changes_json(const TrialRecord& trial, const Drive& drive, const GlobalMap& map) {
  if (!trial.pose || trial.motion != Motion::planar || map.grid().cells.empty()) return std::nullopt;
  const StepResult& declared = trial.records[trial.steps - 1].result;
  MapChanges changes(map);
  const auto add = [&](std::size_t step, const Pose3& map_from_robot) {
    changes.add(drive.samples[trial.start_sample + step].observation.scan,
                seen_from_above(map.relative(map_from_robot)));
  };
  for (std::size_t i = 0; i < trial.records.size(); ++i) {
    const StepResult& step = trial.records[i].result;
    if (i < trial.steps && step.local_map_epoch == declared.local_map_epoch) {
      add(i, *trial.pose * inverse(declared.local_from_robot) * step.local_from_robot);
    } else if (step.verdict.map_from_robot) {
      add(i, *step.verdict.map_from_robot);
    }
  }
  const nlohmann::ordered_json json = {{"new", json_of(changes.brought(), map.origin())},
                                       {"gone", json_of(changes.taken(), map.origin())}};
  return json.dump(1) + "\n";
}

}  // namespace glocal
