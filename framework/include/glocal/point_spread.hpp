// How points spread, and the plane they lie in.
#pragma once

#include <Eigen/Eigenvalues>
#include <optional>

#include "glocal/points.hpp"

namespace glocal {

/// Sums over points, relative to a place that is near to them.
template <class Scalar>
class PointSums {
 public:
  void add(Scalar x, Scalar y, Scalar z) {
    n_ += 1;
    x_ += x;
    y_ += y;
    z_ += z;
    xx_ += x * x;
    xy_ += x * y;
    xz_ += x * z;
    yy_ += y * y;
    yz_ += y * z;
    zz_ += z * z;
  }
  [[nodiscard]] Scalar size() const { return n_; }

  /// Of one point at least.
  [[nodiscard]] Eigen::Matrix<Scalar, 3, 3> covariance() const {
    const Scalar scale = 1 / n_;
    const auto moment = [&](Scalar product, Scalar a, Scalar b) { return scale * (product - scale * a * b); };
    const Scalar xy = moment(xy_, x_, y_);
    const Scalar xz = moment(xz_, x_, z_);
    const Scalar yz = moment(yz_, y_, z_);
    return Eigen::Matrix<Scalar, 3, 3>{
        {moment(xx_, x_, x_), xy, xz}, {xy, moment(yy_, y_, y_), yz}, {xz, yz, moment(zz_, z_, z_)}};
  }
  /// The direction in which they spread least (principal component analysis), if they lie in a plane:
  /// variances along the other two have this ratio at least, and the least one to the next this ratio at
  /// most.
  [[nodiscard]] std::optional<Point> plane_normal(Scalar thinnest_width, Scalar thickest) const {
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix<Scalar, 3, 3>> solver;
    solver.computeDirect(covariance());
    const auto& spread = solver.eigenvalues();
    if (spread[1] < thinnest_width * spread[2] || spread[0] > thickest * spread[1]) return std::nullopt;
    return as_point(solver.eigenvectors().col(0).normalized().template cast<double>());
  }

 private:
  Scalar n_ = 0, x_ = 0, y_ = 0, z_ = 0;
  Scalar xx_ = 0, xy_ = 0, xz_ = 0, yy_ = 0, yz_ = 0, zz_ = 0;
};

}  // namespace glocal
