// Rigid motions in space as inner loops want them.
#pragma once

#include <array>
#include <cmath>

#include "glocal/points.hpp"
#include "glocal/pose3.hpp"

namespace glocal {

/// A pose with the matrix of its rotation at hand (row by row), for moving many points.
struct RigidMotion {
  using Rows = Eigen::Matrix<float, 3, 3, Eigen::RowMajor>;

  std::array<float, 9> rotation{1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F};
  Point translation;

  RigidMotion() = default;
  explicit RigidMotion(const Pose3& target_from_source)
      : translation(as_point(target_from_source.translation())) {
    Eigen::Map<Rows>(rotation.data()) = target_from_source.rotation.toRotationMatrix().cast<float>();
  }

  /// A direction, turned.
  [[nodiscard]] Point turned(const Point& v) const {
    const auto& r = rotation;
    return {r[0] * v.x + r[1] * v.y + r[2] * v.z, r[3] * v.x + r[4] * v.y + r[5] * v.z,
            r[6] * v.x + r[7] * v.y + r[8] * v.z};
  }
  [[nodiscard]] Point operator()(const Point& p) const { return turned(p) + translation; }

  [[nodiscard]] Pose3 pose() const {
    const Eigen::Map<const Rows> matrix(rotation.data());
    return {as_vector(translation), Quaternion(matrix.cast<double>()).normalized()};
  }
};

/// `source_from_target` of a `target_from_source`.
[[nodiscard]] inline RigidMotion inverse(const RigidMotion& motion) {
  const auto& r = motion.rotation;
  RigidMotion back;
  back.rotation = {r[0], r[3], r[6], r[1], r[4], r[7], r[2], r[5], r[8]};
  back.translation = -1.0F * back.turned(motion.translation);
  return back;
}

/// Whether a motion that a few points propose can be one of clouds which both stand upright: such motions are
/// a few degrees off.
[[nodiscard]] inline bool is_about_upright(const RigidMotion& motion) {
  constexpr float least_cosine = 0.97F;  // 14 degrees
  return motion.rotation[8] >= least_cosine;
}

/// The turn about z, with a shift, that is nearest to a motion and moves one point as it does.
[[nodiscard]] inline RigidMotion made_upright(const RigidMotion& motion, const Point& moved_alike) {
  const auto& r = motion.rotation;
  const float cosine = r[0] + r[4];
  const float sine = r[3] - r[1];
  const float scale = 1.0F / std::hypot(cosine, sine);
  const float c = scale * cosine;
  const float s = scale * sine;
  RigidMotion result;
  result.rotation = {c, -s, 0.0F, s, c, 0.0F, 0.0F, 0.0F, 1.0F};
  result.translation = motion(moved_alike) - result.turned(moved_alike);
  return result;
}

/// The cosine of the angle between two orientations.
[[nodiscard]] inline float cosine_between(const RigidMotion& a, const RigidMotion& b) {
  float trace = 0.0F;
  for (std::size_t i = 0; i < 9; ++i) trace += a.rotation[i] * b.rotation[i];
  return (trace - 1.0F) / 2.0F;
}

}  // namespace glocal
