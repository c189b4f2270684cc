#include "matchers/surfels/point_to_plane.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>

namespace glocal::surfels {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// Normal equations of a small turn about the origin of `middle`, and a shift.
struct Equations {
  std::array<float, 21> a{};  ///< Lower triangle.
  std::array<float, 6> b{};

  /// `upright`: as if a turn about x or y moved nothing, so that there is none.
  void add(const Point& arm, const Point& normal, float residual, float weight, bool upright) {
    const Point turn = cross(arm, normal);
    const std::array<float, 6> j = {
        upright ? 0.0F : turn.x, upright ? 0.0F : turn.y, turn.z, normal.x, normal.y, normal.z};
    std::size_t k = 0;
    for (std::size_t row = 0; row < 6; ++row) {
      const float weighted = weight * j[row];
      for (std::size_t column = 0; column <= row; ++column) a[k++] += weighted * j[column];
      b[row] -= weighted * residual;
    }
  }

  [[nodiscard]] Vector6 solution() const {
    Matrix6 matrix;
    Vector6 right;
    std::size_t k = 0;
    double trace = 0.0;
    for (int row = 0; row < 6; ++row) {
      for (int column = 0; column <= row; ++column) {
        matrix(row, column) = static_cast<double>(a[k++]);
        matrix(column, row) = matrix(row, column);
      }
      right[row] = static_cast<double>(b[static_cast<std::size_t>(row)]);
      trace += matrix(row, row);
    }
    // What the surfaces leave free stays as it is.
    matrix.diagonal().array() += 1e-4 * trace + 1e-9;
    return matrix.ldlt().solve(right);
  }
};

}  // namespace

RigidMotion refined(const RigidMotion& target_from_source, const SurfelSample& sample, std::size_t n,
                    const SurfelContact& target, int steps, bool upright) {
  Pose3 pose = target_from_source.pose();
  for (int step = 0; step < steps; ++step) {
    const RigidMotion motion(pose);
    Equations equations;
    for (std::size_t i = 0; i < std::min(n, sample.size()); ++i) {
      const Point p = motion(sample.points[i]);
      const std::uint32_t k = target.nearest(p);
      if (k == VoxelTable::none || !target.lies_on(k, p, motion.turned(sample.normals[i]))) continue;
      const SurfelContact::Plane& plane = target.plane(k);
      const float residual = dot(plane.normal, p) - plane.distance;
      const float share = residual / target.reach();
      const float root = 1.0F - share * share;
      equations.add(p - motion.translation, plane.normal, residual, root * root, upright);
    }
    const Vector6 x = equations.solution();
    pose = {pose.translation() + x.tail<3>(), composed(exponential(x.head<3>()), pose.rotation)};
  }
  return RigidMotion(pose);
}

}  // namespace glocal::surfels
