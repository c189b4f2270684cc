#include "clouds.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>

namespace glocal {

Cloud::Ptr cloud(const Points& points, std::size_t at_most) {
  auto result = std::make_shared<Cloud>();
  const std::size_t n = at_most == 0 ? points.size() : std::min(at_most, points.size());
  for (std::size_t i = 0; i < n; ++i) {
    const Point p = points[i * points.size() / n];
    result->push_back({p.x, p.y, p.z});
  }
  return result;
}

Eigen::Matrix4f matrix(const Pose2& pose) {
  Eigen::Matrix4f m = Eigen::Matrix4f::Identity();
  m.topLeftCorner<2, 2>() = Eigen::Rotation2Df(static_cast<float>(pose.theta)).matrix();
  m(0, 3) = static_cast<float>(pose.x);
  m(1, 3) = static_cast<float>(pose.y);
  return m;
}

Pose2 pose(const Eigen::Matrix4f& matrix) {
  return {matrix(0, 3), matrix(1, 3), wrap_angle(std::atan2(matrix(1, 0), matrix(0, 0)))};
}

}  // namespace glocal
