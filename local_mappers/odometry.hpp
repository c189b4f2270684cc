// Scans joined by odometry alone.
#pragma once

#include <optional>

#include "glocal/params.hpp"
#include "glocal/strategies.hpp"
#include "local_mappers/scan_normals.hpp"
#include "local_mappers/voxel_map.hpp"

namespace glocal {

/// Believes odometry: no scan corrects it. What scan matching is worth shows beside this. The map starts anew
/// (the next epoch) when the robot leaves what the grid can hold.
class Odometry final : public LocalMapper {
 public:
  struct Params {
    VoxelParams voxels = {};
    ScanNormalParams normals = {};
  };

  explicit Odometry(const Params& params);

  void add(const Observation& observation) override;
  [[nodiscard]] const LocalMap& map() const override { return map_.map(); }
  void reset() override;

 private:
  Params params_;
  VoxelMap map_;
  std::optional<Pose2> odom_from_local_;  ///< Where the map was begun; none before the first observation.
};
void describe(ParamVisitor& v, Odometry::Params& p);

}  // namespace glocal
