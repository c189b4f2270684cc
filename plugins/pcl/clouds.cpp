#include "clouds.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <memory>

#include "glocal/evenly.hpp"

namespace glocal::pcl_plugin {

Cloud::Ptr cloud(const Points& points, std::size_t at_most) {
  auto result = std::make_shared<Cloud>();
  for (const std::size_t i : evenly_chosen(points.size(), at_most == 0 ? points.size() : at_most)) {
    const Point p = points[i];
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

}  // namespace glocal::pcl_plugin
