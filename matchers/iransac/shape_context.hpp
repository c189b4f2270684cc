// What a point of a map looks like from where it is: the features that iransac matches.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "matchers/common/oriented_points.hpp"

namespace glocal::iransac {

/// A histogram of the points around one, over their distance and their bearing from its normal.
struct ShapeContextRule {
  double radius = 4.0;    ///< m; farther points do not count.
  double nearest = 0.25;  ///< m; outer edge of the innermost ring. Rings grow by a constant factor.
  int rings = 5;
  int sectors = 12;  ///< Of the half turn on the free side of the point's surface.
};

/// A set of vectors of one length, one after the other.
struct FeatureVectors {
  std::size_t dimensions = 0;
  std::vector<float> values;

  [[nodiscard]] std::size_t size() const { return dimensions == 0 ? 0 : values.size() / dimensions; }
  [[nodiscard]] const float* operator[](std::size_t i) const { return &values[i * dimensions]; }
};

[[nodiscard]] float dot(const float* a, const float* b, std::size_t dimensions);
[[nodiscard]] float squared_distance(const float* a, const float* b, std::size_t dimensions);

/// Shape contexts (Belongie, Malik and Puzicha 2002) of some points among oriented points, by their numbers,
/// generalised as by Mori, Belongie and Malik 2005: a bin holds not how many points lie in it, but the sum of
/// their oriented points' directions, so that a wall seen along differs from one seen across. Directions are
/// relative to the point's normal, as bearings are: the vector stays the same when all points are moved by
/// one rigid motion.
///
/// Ours: only what lies on the free side of the point's surface counts, and only oriented points that face
/// the point, since a robot seldom sees more of them; a point between the middles of two bins is shared out
/// between both; a bin's vector gets the square root of its length, so that one long wall does not drown all
/// others. Each has two numbers for a bin, and length 1; or 0, where a point has no neighbours. The same for
/// any number of threads.
[[nodiscard]] FeatureVectors shape_contexts(const OrientedPoints& oriented_points,
                                            const std::vector<std::uint32_t>& of,
                                            const ShapeContextRule& rule, int threads = 1);

}  // namespace glocal::iransac
