#include "glocal/points.hpp"

#include "glocal/pose3.hpp"

namespace glocal {

Points moved(const Points& points, const Pose3& target_from_source) {
  const std::array<double, 9> r = matrix_of(target_from_source.rotation);
  Points result;
  result.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double x = points.x[i];
    const double y = points.y[i];
    const double z = points.z[i];
    result.push_back({static_cast<float>(r[0] * x + r[1] * y + r[2] * z + target_from_source.x),
                      static_cast<float>(r[3] * x + r[4] * y + r[5] * z + target_from_source.y),
                      static_cast<float>(r[6] * x + r[7] * y + r[8] * z + target_from_source.z)});
  }
  return result;
}

}  // namespace glocal
