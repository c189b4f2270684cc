#include "matchers/mcl/free_space.hpp"

#include <numbers>

#include "glocal/error.hpp"

namespace glocal::mcl {

FreeSpace::FreeSpace(const OccupancyGrid& grid)
    : map_from_grid_(grid.map_from_grid),
      resolution_(grid.resolution),
      width_(static_cast<std::uint32_t>(grid.width)) {
  for (std::size_t i = 0; i < grid.cells.size(); ++i) {
    if (grid.cells[i] == Cell::free) cells_.push_back(static_cast<std::uint32_t>(i));
  }
  if (cells_.empty()) {
    throw ConfigError(
        "",
        "the map has no cell that is known to be free, so there is no place for particles; take a map with "
        "free space, or another matcher");
  }
}

Pose2 FreeSpace::draw(Rng& rng) const {
  const std::uint32_t cell = cells_[rng.below(static_cast<std::uint32_t>(cells_.size()))];
  const std::uint32_t column = cell % width_;
  const std::uint32_t row = cell / width_;
  const double x = (column + rng.uniform()) * resolution_;
  const double y = (row + rng.uniform()) * resolution_;
  const double heading = rng.uniform(-std::numbers::pi, std::numbers::pi);
  return map_from_grid_ * Pose2{x, y, heading};
}

std::shared_ptr<const FreeSpace> free_space(const GlobalMap& map) {
  return map.index<FreeSpace>("", [&] { return FreeSpace(map.grid()); });
}

}  // namespace glocal::mcl
