#include "matchers/surfels/point_to_plane.hpp"

#include <algorithm>

#include "glocal/motion_equations.hpp"

namespace glocal::surfels {

RigidMotion refined(const RigidMotion& target_from_source, const SurfelSample& sample, std::size_t n,
                    const SurfelContact& target, int steps, bool upright) {
  // About the middle of the points, so that a turn moves none of them far: their origin may be anywhere.
  const Pose3 source_from_middle{as_vector(sample.middle)};
  const Pose3 middle_from_source = inverse(source_from_middle);
  Pose3 pose = target_from_source.pose() * source_from_middle;
  for (int step = 0; step < steps; ++step) {
    const RigidMotion motion(pose * middle_from_source);
    const Point middle = as_point(pose.translation());
    MotionEquations<float> equations;
    for (std::size_t i = 0; i < std::min(n, sample.size()); ++i) {
      const Point p = motion(sample.points[i]);
      const std::uint32_t k = target.nearest(p);
      if (k == VoxelTable::none || !target.lies_on(k, p, motion.turned(sample.normals[i]))) continue;
      const SurfelContact::Plane& plane = target.plane(k);
      const float residual = dot(plane.normal, p) - plane.distance;
      const float share = residual / target.reach();
      const float root = 1.0F - share * share;
      const Point normal = plane.normal;
      const Point turn = cross(p - middle, normal);
      // Upright: as if a turn about x or y moved nothing, so that there is none.
      equations.add({upright ? 0.0F : turn.x, upright ? 0.0F : turn.y, turn.z, normal.x, normal.y, normal.z},
                    residual, root * root);
    }
    pose = stepped(pose, equations.step(1e-9, 1e-4));
  }
  return RigidMotion(pose * middle_from_source);
}

}  // namespace glocal::surfels
