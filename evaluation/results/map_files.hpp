// The map in a results folder: its points, and what is known of its cells.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "glocal/global_map.hpp"
#include "glocal/pose3.hpp"

namespace glocal {

/// Where a results folder has the map's points, as PCD, and its cells, as grid_json().
inline constexpr const char* map_points_file = "maps/global.pcd";
inline constexpr const char* map_grid_file = "maps/global_grid.json";

/// A grid with its cells as run lengths: "12u3f" is 12 unknown cells and then 3 free ones ('o': occupied),
/// row by row as in OccupancyGrid, runs going on in the next row. Its corner is in the map's frame, while the
/// grid is relative to the map's origin.
[[nodiscard]] nlohmann::ordered_json grid_json(const OccupancyGrid& grid,
                                               const Vector3& origin = Vector3::Zero());

/// A file as grid_json() makes it. Throws ConfigError for any other, and where the cells are not as many as
/// width and height say.
[[nodiscard]] nlohmann::ordered_json read_grid(const std::filesystem::path& file);

/// The files of a map, by their names in the results folder; a map without cells has no grid.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> map_files(const GlobalMap& map);

}  // namespace glocal
