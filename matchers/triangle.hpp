// Triples of points and the relation that a rigid motion leaves unchanged (Section II of the paper, eq. 1 and
// 2).
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "glocal/points.hpp"

namespace glocal {

/// Three indexes into a point set.
using Triple = std::array<std::uint32_t, 3>;

/// The quantised side lengths of a triangle, longest first, then counter-clockwise: 12 bits each in units of
/// a relation cell.
using Relation = std::uint64_t;
inline constexpr unsigned relation_side_bits = 12;
inline constexpr unsigned relation_bits = 3 * relation_side_bits;

/// Which triangles are worth a relation.
struct TriangleRule {
  double cell = 0.1;        ///< Side lengths that differ by less can have the same relation, m.
  double min_side = 0.3;    ///< Shorter sides give poor poses, m.
  double min_height = 0.1;  ///< So do flat triangles: the height over the longest side, m.
  double max_side = 400.0;  ///< Longer sides cannot occur on the other side, m; at most `cell` * 2^12.
};

struct CanonicalTriangle {
  Triple triple;  ///< Counter-clockwise, the longest side from [0] to [1].
  Relation relation;
};

/// The triangle in an order that does not depend on the order of drawing; mirrored triangles have different
/// relations, as a motion in the plane cannot rotate one into the other. Heights play no part: a robot on a
/// floor does not change them. None if the rule excludes it (always so if two points are the same).
[[nodiscard]] std::optional<CanonicalTriangle> canonical_triangle(const Points& points, Triple triple,
                                                                  const TriangleRule& rule);

/// The motion in the plane that moves the points of `from` onto those of `to` with the least sum of squares
/// (eq. 3, with centroids; closed form in two dimensions). The triples must be canonical.
[[nodiscard]] Transform least_squares_motion(const Points& from_points, const Triple& from,
                                             const Points& to_points, const Triple& to);

}  // namespace glocal
