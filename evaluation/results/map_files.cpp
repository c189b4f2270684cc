#include "evaluation/results/map_files.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cstdint>
#include <optional>
#include <string_view>

#include "config/text_file.hpp"
#include "evaluation/results/file_io.hpp"
#include "evaluation/results/pcd.hpp"
#include "glocal/error.hpp"

namespace glocal {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view cell_letters = "ufo";  // in the order of Cell

/// How many cells a text of run lengths has; none if it is no such text.
std::optional<std::uint64_t> cells_in(std::string_view runs) {
  std::uint64_t cells = 0;
  while (!runs.empty()) {
    std::uint32_t length = 0;
    const auto [end, error] = std::from_chars(runs.data(), runs.data() + runs.size(), length);
    const auto digits = static_cast<std::size_t>(end - runs.data());
    if (error != std::errc{} || digits == runs.size() || cell_letters.find(*end) == std::string_view::npos)
      return std::nullopt;
    cells += length;
    runs.remove_prefix(digits + 1);
  }
  return cells;
}

/// Whether there is a grid with so many cells.
bool is_grid(const Json& grid) {
  const auto is_number = [](const Json& of, const char* key) {
    return of.contains(key) && of[key].is_number();
  };
  const auto is_size = [&](const char* key) { return grid.contains(key) && grid[key].is_number_unsigned(); };
  if (!grid.is_object() || !is_number(grid, "resolution") || !is_size("width") || !is_size("height") ||
      !grid.contains("origin") || !grid.contains("cells") || !grid["cells"].is_string())
    return false;
  for (const char* coordinate : {"x", "y", "theta"}) {
    if (!is_number(grid["origin"], coordinate)) return false;
  }
  const auto width = grid["width"].get<std::uint64_t>();
  const auto height = grid["height"].get<std::uint64_t>();
  constexpr auto most = static_cast<std::uint64_t>(max_grid_cells);
  return grid["resolution"] > 0.0 && width <= most && height <= most &&
         cells_in(grid["cells"].get_ref<const std::string&>()) == width * height;
}

}  // namespace

Json grid_json(const OccupancyGrid& grid, const Vector3& origin) {
  std::string runs;
  for (std::size_t begin = 0; begin < grid.cells.size();) {
    std::size_t end = begin;
    while (end < grid.cells.size() && grid.cells[end] == grid.cells[begin]) ++end;
    runs += fmt::format("{}{}", end - begin, cell_letters[static_cast<std::size_t>(grid.cells[begin])]);
    begin = end;
  }
  const Pose2& corner = grid.map_from_grid;
  return {{"resolution", grid.resolution},
          {"origin", {{"x", origin.x() + corner.x}, {"y", origin.y() + corner.y}, {"theta", corner.theta}}},
          {"width", grid.width},
          {"height", grid.height},
          {"cells", runs}};
}

Json read_grid(const std::filesystem::path& file) {
  const auto refuse = [&](const char* what) {
    throw ConfigError(file, fmt::format("{}; run the experiment again", what));
  };
  if (why_unreadable(file)) refuse("cannot be read");
  Json grid = Json::parse(content_of(file), nullptr, false);
  if (!is_grid(grid)) refuse("is no grid as glocal run leaves it (resolution, origin, width, height, cells)");
  return grid;
}

std::vector<std::pair<std::string, std::string>> map_files(const GlobalMap& map) {
  std::vector<std::pair<std::string, std::string>> files = {
      {map_points_file, pcd(map.points(), map.origin())}};
  if (!map.grid().cells.empty())
    files.emplace_back(map_grid_file, grid_json(map.grid(), map.origin()).dump() + "\n");
  return files;
}

}  // namespace glocal
