// How a robot has moved, as odometry tells: the motion and its noise.
#pragma once

#include "glocal/params.hpp"
#include "glocal/pose2.hpp"
#include "glocal/rng.hpp"

namespace glocal::mcl {

/// Noise of odometry. Names and defaults are those of AMCL (Nav2).
struct OdometryNoise {
  double alpha1 = 0.2;  ///< Variance of a rotation, of each squared radian turned.
  double alpha2 = 0.2;  ///< rad^2/m^2; the same, of each squared metre driven.
  double alpha3 = 0.2;  ///< Variance of the way, of each squared metre driven.
  double alpha4 = 0.2;  ///< m^2/rad^2; the same, of each squared radian turned.
};
void describe(ParamVisitor& v, OdometryNoise& p);

/// The odometry motion model (Thrun, Burgard and Fox, Probabilistic Robotics, Table 5.6): an increment is a
/// rotation towards where the robot went, a straight way, and a rotation to its new heading, each with noise
/// of its own.
class OdometryMotion {
 public:
  /// The increment is the robot's new pose in the frame of its old one.
  OdometryMotion(const Pose2& old_from_new, const OdometryNoise& noise);

  /// A new pose for an old one, with random noise.
  [[nodiscard]] Pose2 sample(const Pose2& map_from_old, Rng& rng) const;

 private:
  double first_rotation_, way_, second_rotation_;
  double first_deviation_, way_deviation_, second_deviation_;
};

}  // namespace glocal::mcl
