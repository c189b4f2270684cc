#include "evaluation/running/drive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "glocal/contact.hpp"
#include "glocal/error.hpp"

namespace glocal {
namespace {

bool has_reference(const Sample& sample) {
  return sample.map_from_robot.has_value();
}

double distance_to_path(const Pose3& pose, const std::vector<Pose3>& path) {
  double least = std::numeric_limits<double>::infinity();
  for (const Pose3& p : path) least = std::min(least, distance(pose, p));
  return least;
}

/// Whether the grid knows a free cell within `reach` of the pose.
bool near_free_cell(const Pose3& pose, const OccupancyGrid& grid, double reach) {
  // The grid has nothing farther away.
  reach = std::min(
      reach, distance(pose, grid.map_from_grid) + std::hypot(grid.width, grid.height) * grid.resolution);
  // From the pose itself outwards, so that its own cell counts however short the reach is.
  const int cells = static_cast<int>(reach / grid.resolution);
  for (int row = -cells; row <= cells; ++row) {
    for (int column = -cells; column <= cells; ++column) {
      const double dx = column * grid.resolution;
      const double dy = row * grid.resolution;
      if (dx * dx + dy * dy <= reach * reach && grid.at(pose.x + dx, pose.y + dy) == Cell::free) return true;
    }
  }
  return false;
}

/// Whether the map has a point within `reach` of the pose, which is relative to its origin.
bool near_point(const Pose3& pose, const GlobalMap& map, double reach) {
  Points place;
  place.push_back(as_point(pose.translation()));
  return contact_index(map, "kd_tree", reach)->count(place, 0, 1, Transform(Pose2{})) > 0;
}

/// A map made from a drive is known near that drive's path; another one is known where cells are free; one of
/// points alone is known near these.
bool within_map(const Sample& sample, const GlobalMap& map, double reach) {
  if (reach <= 0.0 || !has_reference(sample)) return true;
  const Pose3 pose = map.relative(*sample.map_from_robot);
  if (!map.path().empty()) return distance_to_path(pose, map.path()) <= reach;
  return map.grid().cells.empty() ? near_point(pose, map, reach) : near_free_cell(pose, map.grid(), reach);
}

std::vector<std::size_t> starts_at(const std::vector<double>& places_m, const Drive& drive) {
  std::vector<std::size_t> starts;
  for (const double place : places_m) {
    const auto it = std::lower_bound(drive.path_m.begin(), drive.path_m.end(), place);
    if (it == drive.path_m.end())
      throw ConfigError("",
                        fmt::format("trials: starts_m: {} m is beyond the drive, which ends after {:.1f} m; "
                                    "leave it out",
                                    place, drive.path_m.back()));
    starts.push_back(static_cast<std::size_t>(it - drive.path_m.begin()));
  }
  return starts;
}

std::vector<double> every(double distance_m, double length_m) {
  constexpr double most = 1e6;
  if (length_m / distance_m > most) {
    throw ConfigError("",
                      fmt::format("trials: every_m {} m makes {:.3g} starts along the drive of {:.1f} m, at "
                                  "most a million are allowed; raise it",
                                  distance_m, length_m / distance_m, length_m));
  }
  std::vector<double> places;
  for (std::size_t i = 0; static_cast<double>(i) * distance_m <= length_m; ++i) {
    places.push_back(static_cast<double>(i) * distance_m);
  }
  return places;
}

/// Observations from each start to the end of its segment.
std::vector<std::size_t> steps_left(const Drive& drive) {
  std::vector<std::size_t> left(drive.samples.size(), 1);
  for (std::size_t i = left.size(); i-- > 1;) {
    if (drive.samples[i - 1].segment == drive.samples[i].segment) left[i - 1] = left[i] + 1;
  }
  return left;
}

std::vector<std::size_t> wanted_starts(const TrialsConfig& config, const Drive& drive) {
  if (config.whole) return {0};
  if (config.every_m > 0.0) return starts_at(every(config.every_m, drive.path_m.back()), drive);
  if (!config.starts_m.empty()) return starts_at(config.starts_m, drive);
  std::vector<std::size_t> starts;
  const auto stride = static_cast<std::size_t>(config.every_scan);
  for (std::size_t i = 0; i < drive.samples.size(); i += stride) starts.push_back(i);
  return starts;
}

}  // namespace

Drive read_drive(ObservationSource& source) {
  Drive drive;
  while (std::optional<Sample> sample = source.next()) drive.samples.push_back(std::move(*sample));
  double path = 0.0;
  for (std::size_t i = 0; i < drive.samples.size(); ++i) {
    if (i > 0 && drive.samples[i].segment == drive.samples[i - 1].segment) {
      path += distance(drive.samples[i - 1].observation.odom_from_robot,
                       drive.samples[i].observation.odom_from_robot);
    }
    drive.path_m.push_back(path);
  }
  return drive;
}

std::vector<std::size_t> trial_starts(const TrialsConfig& config, const Drive& drive, const GlobalMap& map) {
  if (drive.samples.empty()) {
    throw ConfigError("", "observations: the drive has no observation; check the source and its segments");
  }
  std::vector<std::size_t> starts = wanted_starts(config, drive);
  std::sort(starts.begin(), starts.end());
  starts.erase(std::unique(starts.begin(), starts.end()), starts.end());
  const std::size_t wanted = starts.size();
  const std::vector<std::size_t> left = steps_left(drive);
  std::erase_if(starts, [&](std::size_t i) {
    return left[i] < static_cast<std::size_t>(config.min_steps) ||
           !within_map(drive.samples[i], map, config.within_map_m);
  });
  if (starts.empty()) {
    throw ConfigError(
        "", fmt::format(
                "trials: none of {} starts along the drive of {:.1f} m lies within {} m of the mapped "
                "area with at least {} observations left; use other starts, another segment of the drive, "
                "a larger trials.within_map_m or a smaller trials.min_steps",
                wanted, drive.path_m.back(), config.within_map_m, config.min_steps));
  }
  return starts;
}

std::vector<std::size_t> chosen_starts(const TrialsConfig& config, const std::vector<std::size_t>& all) {
  if (config.only.empty()) return all;
  std::vector<std::size_t> chosen;
  for (const double number : config.only) {
    if (number >= static_cast<double>(all.size()))
      throw ConfigError("", fmt::format("trials.only: there is no start {:g}; the starts are 0 to {}", number,
                                        all.size() - 1));
    chosen.push_back(all[static_cast<std::size_t>(number)]);
  }
  return chosen;
}

std::size_t start_number(const TrialsConfig& config, std::size_t trial) {
  return config.only.empty() ? trial : static_cast<std::size_t>(config.only[trial]);
}

}  // namespace glocal
