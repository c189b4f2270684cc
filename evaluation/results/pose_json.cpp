#include "evaluation/results/pose_json.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

namespace glocal {
namespace {

/// Of the two quaternions that are the same rotation, the one whose w is not negative.
Quaternion with_positive_w(const Quaternion& q) {
  return q.w() < 0.0 ? Quaternion(-q.coeffs()) : q;
}

}  // namespace

nlohmann::ordered_json to_json(const Pose3& pose, Motion motion) {
  if (motion == Motion::planar) return {{"x", pose.x}, {"y", pose.y}, {"theta", pose.heading()}};
  const Quaternion q = with_positive_w(pose.rotation);
  return {{"x", pose.x}, {"y", pose.y}, {"z", pose.z}, {"qx", q.x()},
          {"qy", q.y()}, {"qz", q.z()}, {"qw", q.w()}, {"theta", pose.heading()}};
}

Pose3 pose_of(const nlohmann::ordered_json& json) {
  const auto number = [&](const char* name) { return json.at(name).get<double>(); };
  if (!json.contains("qw")) return Pose2{number("x"), number("y"), number("theta")};
  const Quaternion rotation{number("qw"), number("qx"), number("qy"), number("qz")};
  constexpr double rounding = 1e-6;
  const double length = rotation.norm();
  if (!(std::abs(length - 1.0) <= rounding)) throw std::invalid_argument("qx, qy, qz and qw are no rotation");
  return {{number("x"), number("y"), number("z")}, rotation};
}

std::string tum_text(const Pose3& pose) {
  const Quaternion q = with_positive_w(pose.rotation);
  if (pose.is_planar()) return fmt::format("{:.6f} {:.6f} 0 0 0 {:.9f} {:.9f}", pose.x, pose.y, q.z(), q.w());
  return fmt::format("{:.6f} {:.6f} {:.6f} {:.9f} {:.9f} {:.9f} {:.9f}", pose.x, pose.y, pose.z, q.x(), q.y(),
                     q.z(), q.w());
}

}  // namespace glocal
