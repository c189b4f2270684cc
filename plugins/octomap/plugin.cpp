#include "glocal/plugin.hpp"

#include "octomap_map.hpp"
#include "octomap_mapper.hpp"

GLOCAL_PLUGIN("glocal_octomap", "0.1.0", catalog) {
  using namespace glocal;
  catalog.map_sources.add<octomap_plugin::OctomapMap>(
      "octomap", "A map of OctoMap: a .bt or .ot file, or a band of heights of it.", stable_since("0.1.0"));
  catalog.local_mappers.add<octomap_plugin::OctomapMapper>(
      "octomap", "An octree of occupancy: what later rays pass through, as people who walked by, fades.",
      stable_since("0.1.0"), {.mappers = &catalog.local_mappers});
}
