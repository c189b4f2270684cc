#include "local_mappers/odometry.hpp"

#include "local_mappers/first_pose.hpp"
#include "local_mappers/scan_normals.hpp"

namespace glocal::local_mappers {

void describe(ParamVisitor& v, Odometry::Params& p) {
  describe(v, p.voxels);
}

// Nobody asks for the nearest point or for likelihoods: a point stamps its own cell only.
Odometry::Odometry(const Params& params, const StageSetup& setup)
    : motion_(setup.motion), map_(params.voxels, 0, params.voxels.resolution) {}

void Odometry::add(const Observation& observation) {
  if (odom_from_first_) {
    move_to(observation.odom_from_robot);
  } else {
    begin(observation.odom_from_robot);
  }
  if (!map_.holds_robot()) {
    map_.start_over();
    begin(observation.odom_from_robot);
  }
  map_.add(placed(observation.scan));
}

void Odometry::begin(const Pose3& odom_from_robot) {
  odom_from_first_ = odom_from_robot;
  map_.move_robot(first_pose(odom_from_robot, motion_));
}

void Odometry::move_to(const Pose3& odom_from_robot) {
  if (motion_ == Motion::planar) {
    map_.move_robot(inverse(seen_from_above(*odom_from_first_)) * seen_from_above(odom_from_robot));
  } else {
    map_.move_robot(first_pose(*odom_from_first_, motion_) * (inverse(*odom_from_first_) * odom_from_robot));
  }
}

LocalScan Odometry::placed(const Scan& scan) const {
  if (motion_ != Motion::planar) return LocalScan(moved(scan.hits, map_.map().local_from_robot));
  return {scan.hits, scan_normals(scan.hits, scan.origin, {}), map_.robot()};
}

void Odometry::reset() {
  map_.reset();
  odom_from_first_.reset();
}

}  // namespace glocal::local_mappers
