#include "local_mappers/odometry.hpp"

namespace glocal {

void describe(ParamVisitor& v, Odometry::Params& p) {
  describe(v, p.voxels);
  v.field("normals", p.normals, {.doc = "Normals of a scan.", .audience = Audience::expert});
}

// Nobody asks for the nearest point or for likelihoods: a point stamps its own cell only.
Odometry::Odometry(const Params& params)
    : params_(params), map_(params.voxels, 0, params.voxels.resolution) {}

void Odometry::add(const Observation& observation) {
  const Pose2 odom_from_robot = seen_from_above(observation.odom_from_robot);
  if (!odom_from_local_) odom_from_local_ = odom_from_robot;
  map_.move_robot(inverse(*odom_from_local_) * odom_from_robot);
  if (!map_.holds_robot()) {
    map_.start_over();
    odom_from_local_ = odom_from_robot;
  }
  const Scan& scan = observation.scan;
  map_.add({scan.hits, scan_normals(scan.hits, scan.origin, params_.normals), map_.robot()});
}

void Odometry::reset() {
  map_.reset();
  odom_from_local_.reset();
}

}  // namespace glocal
