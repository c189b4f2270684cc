// Maps of OctoMap.
#pragma once

#include <string>
#include <vector>

#include "glocal/catalog.hpp"
#include "glocal/params.hpp"
#include "glocal/strategies.hpp"

namespace glocal::octomap_plugin {

/// An octree's voxels between two heights: as a plan, or as points in space.
class OctomapMap final : public MapSource {
 public:
  struct Params {
    FilePath path;
    double min_height = -1000.0;
    double max_height = 1000.0;
    double occupied_above = 0.5;
    int min_voxels = 1;
    std::string points = "plan";
    std::vector<double> tree_pose = {0.0, 0.0, 0.0};
  };

  OctomapMap(const Params& params, const SourceSetup& setup);

  /// Throws ConfigError for what is no octree, a map too large to hold, or nothing occupied between the
  /// heights.
  [[nodiscard]] MapData load() override;

 private:
  Params params_;
};
void describe(ParamVisitor& v, OctomapMap::Params& p);

}  // namespace glocal::octomap_plugin
