// Scans joined by odometry alone.
#pragma once

#include <optional>

#include "glocal/catalog.hpp"
#include "glocal/params.hpp"
#include "glocal/strategies.hpp"
#include "local_mappers/voxel_map.hpp"

namespace glocal::local_mappers {

/// Believes odometry: no scan corrects it. What scan matching is worth shows beside this. The map starts anew
/// (the next epoch) when the robot leaves what the grid can hold. Only a map in the plane has normals: they
/// are made of beams that follow one another in it.
class Odometry final : public LocalMapper {
 public:
  static constexpr Motions motions = all_motions;
  struct Params {
    VoxelParams voxels = {};
  };

  Odometry(const Params& params, const StageSetup& setup);

  void add(const Observation& observation) override;
  [[nodiscard]] const LocalMap& map() const override { return map_.map(); }
  void reset() override;

 private:
  void begin(const Pose3& odom_from_robot);
  void move_to(const Pose3& odom_from_robot);
  [[nodiscard]] LocalScan placed(const Scan& scan) const;

  Motion motion_;
  VoxelMap map_;
  std::optional<Pose3> odom_from_first_;  ///< The robot where the map was begun; none before that.
};
void describe(ParamVisitor& v, Odometry::Params& p);

}  // namespace glocal::local_mappers
