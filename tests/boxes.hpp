// Boxes that worlds of tests are made of, and where rays meet them.
#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include "glocal/pose3.hpp"

namespace glocal::test {

/// A box with its edges along the axes, m; seen from within it is a room.
struct Box {
  Vector3 least, most;
};

/// How far along a ray a box begins and ends, by the slabs between opposite faces: the end is less where the
/// ray misses it. The ray is along no axis.
inline std::array<double, 2> crossing(const Box& box, const Vector3& from, const Vector3& direction) {
  double enter = -std::numeric_limits<double>::infinity();
  double leave = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (box.least[axis] - from[axis]) / direction[axis];
    const double b = (box.most[axis] - from[axis]) / direction[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return {enter, leave};
}

}  // namespace glocal::test
