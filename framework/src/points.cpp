#include "glocal/points.hpp"

#include <numeric>

namespace glocal {

Points moved(const Points& points, const Pose3& target_from_source) {
  const Eigen::Matrix3d r = target_from_source.rotation.toRotationMatrix();
  Points result;
  result.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double x = points.x[i];
    const double y = points.y[i];
    const double z = points.z[i];
    result.push_back({static_cast<float>(r(0, 0) * x + r(0, 1) * y + r(0, 2) * z + target_from_source.x),
                      static_cast<float>(r(1, 0) * x + r(1, 1) * y + r(1, 2) * z + target_from_source.y),
                      static_cast<float>(r(2, 0) * x + r(2, 1) * y + r(2, 2) * z + target_from_source.z)});
  }
  return result;
}

Vector3 centroid(const Points& points) {
  const auto mean = [](const std::vector<float>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  };
  return {mean(points.x), mean(points.y), mean(points.z)};
}

}  // namespace glocal
