#pragma once

#include "glocal/pose2.hpp"

namespace glocal {

/// How far a pose may be from another one, and turned, to be near it. Where nothing else is said, poses near
/// each other are one answer, and others are rivals.
struct PoseTolerance {
  static constexpr double default_translation = 1.0;    ///< m
  static constexpr double default_rotation_deg = 30.0;  ///< deg

  double translation = default_translation;         ///< m
  double rotation = radians(default_rotation_deg);  ///< rad

  /// Of two poses of one kind, in the plane or in space.
  template <class Pose>
  [[nodiscard]] bool are_near(const Pose& a, const Pose& b) const {
    return distance(a, b) <= translation && rotation_between(a, b) <= rotation;
  }
};

}  // namespace glocal
