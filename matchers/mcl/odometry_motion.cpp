#include "matchers/mcl/odometry_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glocal::mcl {
namespace {

double squared(double value) {
  return value * value;
}

/// A robot that backs up has not turned around: its rotations are as exact as those of one that drives
/// forward (as in AMCL).
double squared_turn(double rotation) {
  const double turn = std::abs(wrap_angle(rotation));
  return squared(std::min(turn, std::numbers::pi - turn));
}

}  // namespace

void describe(ParamVisitor& v, OdometryNoise& p) {
  v.field("alpha1", p.alpha1,
          {.doc = "Noise of a rotation: variance for each squared radian turned (Probabilistic Robotics, "
                  "Table 5.6, as the other alphas).",
           .min = 0.0,
           .max = 1000.0});
  v.field("alpha2", p.alpha2,
          {.doc = "Noise of a rotation: variance for each squared metre driven.",
           .unit = "rad^2/m^2",
           .min = 0.0,
           .max = 1000.0});
  v.field("alpha3", p.alpha3,
          {.doc = "Noise of the way: variance for each squared metre driven.", .min = 0.0, .max = 1000.0});
  v.field("alpha4", p.alpha4,
          {.doc = "Noise of the way: variance for each squared radian turned.",
           .unit = "m^2/rad^2",
           .min = 0.0,
           .max = 1000.0});
}

OdometryMotion::OdometryMotion(const Pose2& old_from_new, const OdometryNoise& noise) {
  way_ = std::hypot(old_from_new.x, old_from_new.y);
  // On the spot the direction of the way is only noise (as in AMCL).
  constexpr double least_way = 0.01;
  first_rotation_ = way_ < least_way ? 0.0 : std::atan2(old_from_new.y, old_from_new.x);
  second_rotation_ = wrap_angle(old_from_new.theta - first_rotation_);
  const double first = squared_turn(first_rotation_);
  const double second = squared_turn(second_rotation_);
  const double way = squared(way_);
  first_deviation_ = std::sqrt(noise.alpha1 * first + noise.alpha2 * way);
  way_deviation_ = std::sqrt(noise.alpha3 * way + noise.alpha4 * (first + second));
  second_deviation_ = std::sqrt(noise.alpha1 * second + noise.alpha2 * way);
}

Pose2 OdometryMotion::sample(const Pose2& map_from_old, Rng& rng) const {
  const double first = first_rotation_ - rng.normal(first_deviation_);
  const double way = way_ - rng.normal(way_deviation_);
  const double second = second_rotation_ - rng.normal(second_deviation_);
  const double heading = map_from_old.theta + first;
  return {map_from_old.x + way * std::cos(heading), map_from_old.y + way * std::sin(heading),
          wrap_angle(heading + second)};
}

}  // namespace glocal::mcl
