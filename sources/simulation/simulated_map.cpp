#include "glocal/error.hpp"
#include "glocal/limits.hpp"
#include "sources/simulation/simulation.hpp"
#include "sources/simulation/world_grid.hpp"

namespace glocal::simulation {
void describe(ParamVisitor& v, SimulatedMap::Params& p) {
  v.field("world", p.world, {.doc = "File that describes the world.", .required = true});
  v.field("resolution", p.resolution,
          {.doc = "Side of a cell, and of the cubes that have a point each.",
           .unit = "m",
           .min = least_resolution,
           .max = 10.0});
  v.field("points", p.points,
          {.doc = "Points of the map: the plan's occupied cells, or all surfaces in space, for a lidar.",
           .choices = {"plan", "space"}});
}

SimulatedMap::SimulatedMap(const Params& params, const SourceSetup& setup) : params_(params) {
  setup.note_input(params.world.resolved);
  note_input_ = setup.note_input;
}

MapData SimulatedMap::load() {
  const std::string file = params_.world.resolved.string();
  const World world = read_world(params_.world.resolved);
  MapData map;
  map.grid = plan_of(world, params_.resolution, file);
  map.points = params_.points == "space" ? surface_points(world, map.grid, file) : occupied_centres(map.grid);
  const bool is_of_cloud = params_.points == "space" && !world.cloud.text.empty();
  if (is_of_cloud) {
    note_input_(world.cloud.resolved);
    // Nothing is known of where it is free within a cloud.
    map.grid = {};
    map.resolution = params_.resolution;
  }
  if (map.points.empty()) {
    throw ConfigError(file, "has nothing on its map; give it walls with on_map: true");
  }
  return map;
}

}  // namespace glocal::simulation
