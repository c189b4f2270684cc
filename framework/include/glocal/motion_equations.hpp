// Steps of the Gauss-Newton method that lay points on surfaces.
#pragma once

#include <Eigen/Cholesky>
#include <array>
#include <cstddef>

#include "glocal/pose3.hpp"

namespace glocal {

/// A small turn, as an axis with the angle for its length (rad), and a shift (m).
using MotionStep = Eigen::Matrix<double, 6, 1>;

/// Normal equations of a step; sums in the given precision.
template <class Scalar>
class MotionEquations {
 public:
  /// One residual (m), with its derivative by the turn about x, y and z, and by the shift along them.
  void add(const std::array<Scalar, 6>& derivative, Scalar residual, Scalar weight) {
    std::size_t k = 0;
    for (std::size_t row = 0; row < 6; ++row) {
      const Scalar weighted = weight * derivative[row];
      for (std::size_t column = 0; column <= row; ++column) matrix_[k++] += weighted * derivative[column];
      right_[row] -= weighted * residual;
    }
  }

  /// What no surface determines stays as it is: `damping` and a share of the trace are added to the diagonal.
  [[nodiscard]] MotionStep step(double damping, double share_of_trace = 0.0) const {
    Eigen::Matrix<double, 6, 6> matrix = Eigen::Matrix<double, 6, 6>::Zero();
    std::size_t k = 0;
    // The solver reads the lower triangle.
    for (int row = 0; row < 6; ++row) {
      for (int column = 0; column <= row; ++column) matrix(row, column) = static_cast<double>(matrix_[k++]);
    }
    matrix.diagonal().array() += share_of_trace * matrix.trace() + damping;
    const Eigen::Map<const Eigen::Matrix<Scalar, 6, 1>> right(right_.data());
    return matrix.ldlt().solve(right.template cast<double>());
  }

 private:
  std::array<Scalar, 21> matrix_{};  ///< Lower triangle, row by row.
  std::array<Scalar, 6> right_{};
};

/// The pose after a step that turns about its origin.
[[nodiscard]] inline Pose3 stepped(const Pose3& pose, const MotionStep& step) {
  return {pose.translation() + step.tail<3>(), composed(exponential(step.head<3>()), pose.rotation)};
}

}  // namespace glocal
