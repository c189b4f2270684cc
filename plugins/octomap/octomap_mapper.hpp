// A local map that forgets what has gone.
#pragma once

#include <octomap/OcTree.h>

#include <cstddef>
#include <unordered_map>
#include <vector>

#include "glocal/catalog.hpp"
#include "glocal/params.hpp"
#include "glocal/strategies.hpp"

namespace glocal::octomap_plugin {

/// Occupancy in log-odds with ray casting (Hornung et al. 2013), at poses that another local mapper finds.
/// Points of the map are the voxels that are occupied now, each at the mean of its hits: those of people who
/// walked by fade as later rays pass through.
class OctomapMapper final : public LocalMapper {
 public:
  struct Params {
    StrategyChoice poses{"scan_matching"};
    double resolution = 0.05;
    double hit_probability = 0.7;
    double miss_probability = 0.4;
    double max_probability = 0.9;
    double min_probability = 0.12;
    const Registry<LocalMapper, StageSetup>* mappers = nullptr;  ///< Not described: where `poses` are from.
  };

  OctomapMapper(const Params& params, const StageSetup& setup);

  void add(const Observation& observation) override;
  [[nodiscard]] const LocalMap& map() const override { return map_; }
  void reset() override;
  /// The octree as a .bt file.
  [[nodiscard]] std::vector<MapFile> files() const override;

 private:
  struct Voxel {
    octomap::OcTreeKey key;
    std::size_t observation;           ///< Which one of this epoch hit it first.
    double x = 0.0, y = 0.0, z = 0.0;  ///< Sums over all hits, m.
    double hits = 0.0;
  };
  void start_over();
  void add_hit(const octomap::OcTreeKey& key, const octomap::point3d& end);
  void cast_rays(const Scan& scan, const Pose2& local_from_robot);
  void collect_points();

  std::unique_ptr<LocalMapper> poses_;
  octomap::OcTree tree_;
  std::vector<Voxel> voxels_;  ///< All that were ever hit, in this order.
  std::unordered_map<octomap::OcTreeKey, std::size_t, octomap::OcTreeKey::KeyHash> voxel_of_;
  std::size_t observations_ = 0;  ///< Of this epoch.
  LocalMap map_;
};
void describe(ParamVisitor& v, OctomapMapper::Params& p);

}  // namespace glocal::octomap_plugin
