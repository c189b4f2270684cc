// Triples of points in space: their relation, and the motion between two of them (Section II of the paper,
// eq. 1 to 3).
#pragma once

#include <array>

#include "glocal/pose3.hpp"
#include "matchers/common/triangle.hpp"
#include "matchers/surfels/rigid_motion.hpp"

namespace glocal::ransam {

/// As find_relations(), but sides are those in space, and come in the order of their lengths. Mirrored
/// triangles have the same relation: turned over, one lies on the other.
void find_relations_in_space(const Points& points, const TripleBatch& batch, const TriangleRule& rule,
                             bool neighbours, RelationBatch& relations);

/// Three points in metres.
using Triangle = std::array<Vector3, 3>;

/// A triple's points in the order of relations: against the longest side, the middle one and the shortest.
[[nodiscard]] Triple in_order_of_relation(const Points& points, const Triple& triple);

/// The motion that moves the corners of one triangle onto those of another with the least sum of squares (eq.
/// 3, with centroids). It lays one plane on the other and turns in it, which is optimal for coplanar points
/// (Horn 1987, closed form). Neither triangle has all its corners on a line.
[[nodiscard]] Pose3 least_squares_motion(const Triangle& from, const Triangle& to);

/// Unit normals of the surfaces that a triangle's corners lie on.
using Normals = std::array<Point, 3>;

/// Whether a motion turns the normal at each corner to within 41 degrees of that of its partner. n and -n are
/// the same. That tells a triangle from its mirror image where its surfaces are neither in its plane nor
/// upright on it.
[[nodiscard]] bool surfaces_agree(const RigidMotion& motion, const Normals& from, const Normals& to);

}  // namespace glocal::ransam
