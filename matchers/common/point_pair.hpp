// Two points, and the motion between two such pairs.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "glocal/points.hpp"

namespace glocal {

using PointPair = std::array<Point, 2>;

/// The motion of least squares that lays one pair on another, middle on middle; motion i of a batch.
inline void lay(const PointPair& from, const PointPair& to, MotionBatch& motions, std::size_t i) {
  const float ux = from[1].x - from[0].x;
  const float uy = from[1].y - from[0].y;
  const float vx = to[1].x - to[0].x;
  const float vy = to[1].y - to[0].y;
  const float lengths = std::sqrt((ux * ux + uy * uy) * (vx * vx + vy * vy));
  const float c = (ux * vx + uy * vy) / lengths;
  const float s = (ux * vy - uy * vx) / lengths;
  const float mx = 0.5F * (from[0].x + from[1].x);
  const float my = 0.5F * (from[0].y + from[1].y);
  motions.cosine[i] = c;
  motions.sine[i] = s;
  motions.x[i] = 0.5F * (to[0].x + to[1].x) - (c * mx - s * my);
  motions.y[i] = 0.5F * (to[0].y + to[1].y) - (s * mx + c * my);
}

}  // namespace glocal
