#include "glocal/global_map.hpp"

#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace glocal {
namespace {

/// The heights of planar points are zeros, a third of what points take. The system has one page of them for
/// all who only read: whole pages of zeros are given back to it, and read as zeros from then on.
void give_back_zeros(std::vector<float>& values) {
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  constexpr std::size_t worth_it = 1U << 20U;  // of such size they are pages of their own
  const bool are_zeros =
      std::ranges::all_of(values, [](float v) { return std::bit_cast<std::uint32_t>(v) == 0; });
  if (values.size() < worth_it || !are_zeros) return;
  const auto begin = (reinterpret_cast<std::uintptr_t>(values.data()) + page - 1) / page * page;
  const auto end = reinterpret_cast<std::uintptr_t>(values.data() + values.size()) / page * page;
  madvise(reinterpret_cast<void*>(begin), end - begin, MADV_DONTNEED);  // NOLINT(performance-no-int-to-ptr)
}

}  // namespace

GlobalMap::GlobalMap(MapData data) : data_(std::move(data)) {
  give_back_zeros(data_.points.z);
}

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
  if (slot) return slot;
  slot = build();
#ifdef __GLIBC__
  // What making it has left behind, thread by thread, would stay as long as the program.
  constexpr std::size_t worth_it = 1U << 20U;
  if (points().size() > worth_it) malloc_trim(0);
#endif
  return slot;
}

}  // namespace glocal
