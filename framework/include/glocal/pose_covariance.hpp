// How uncertain a pose is.
#pragma once

#include "glocal/pose2.hpp"

namespace glocal {

/// Covariance of a pose's error: of x and y in the target frame, and of the heading (t). Symmetric, so six
/// values.
struct PoseCovariance {
  double xx = 0.0;  ///< m^2
  double xy = 0.0;
  double xt = 0.0;  ///< m rad
  double yy = 0.0;
  double yt = 0.0;
  double tt = 0.0;  ///< rad^2

  friend bool operator==(const PoseCovariance&, const PoseCovariance&) = default;
};

/// Normalised estimation error squared (NEES): e^T C^-1 e of the error `estimate` less `reference`. 3 in the
/// mean where the covariance is the error's (Bar-Shalom, Li and Kirubarajan 2001, section 5.4). Infinite for
/// a covariance that is not positive definite.
[[nodiscard]] double normalised_error_squared(const Pose2& estimate, const Pose2& reference,
                                              const PoseCovariance& covariance);

}  // namespace glocal
