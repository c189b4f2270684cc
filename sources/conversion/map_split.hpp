// Which parts of a drive a map is made from, and on which the robot is looked for.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sources/conversion/drive_track.hpp"
#include "sources/driven_path.hpp"

namespace glocal::conversion {

/// Parts of a drive that have no scan in common.
struct MapSplit {
  PathSegments map, run;
  double run_near_map = 0.0;  ///< Share of the run's scans that lie within `near_map_m` of the map's path.
};

/// How near to the path of the mapping robot a place counts as mapped, m.
inline constexpr double near_map_m = 2.0;

/// The drive in so many blocks of equal length, each of which begins with a part for the map: this share of
/// it.
[[nodiscard]] MapSplit split_drive(const std::vector<TrackedScan>& scans, int blocks, double map_share);

/// The first 30, 40, 50, 60 or 70 % of the drive, or of each of so many blocks: the least that leaves half of
/// the rest near the map. Of a drive that does not come back, halves of the blocks, or of five.
[[nodiscard]] MapSplit choose_split(const std::vector<TrackedScan>& scans, std::optional<int> blocks = {});

/// "[[0, 0.3], [0.5, 0.8]]"
[[nodiscard]] std::string segments_yaml(const PathSegments& segments);

}  // namespace glocal::conversion
