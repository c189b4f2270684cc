#include "glocal/global_map.hpp"

#include <algorithm>
#include <cmath>

namespace glocal {

Vector3 origin_near(const Vector3& place, Motion motion) {
  constexpr double near_m = 1000.0;  // There single precision is good to 0.06 mm.
  const auto along = [](double value) { return std::abs(value) > near_m ? std::round(value) : 0.0; };
  return {along(place.x()), along(place.y()), motion == Motion::planar ? 0.0 : along(place.z())};
}

MapPlace GlobalMap::place_of(const Pose3& map_from_robot) const {
  if (parts().empty()) return {"", map_from_robot};
  const auto next = std::upper_bound(parts().begin() + 1, parts().end(), map_from_robot.x,
                                     [](double x, const MapPart& part) { return x < part.from_x; });
  const MapPart& part = *(next - 1);
  return {part.name, inverse(part.common_from_part) * map_from_robot};
}

std::shared_ptr<const void> GlobalMap::shared_index(
    std::type_index type, const std::string& key,
    const std::function<std::shared_ptr<const void>()>& build) const {
  const std::lock_guard lock(mutex_);
  std::shared_ptr<const void>& slot = indexes_[{type, key}];
  if (!slot) slot = build();
  return slot;
}

}  // namespace glocal
