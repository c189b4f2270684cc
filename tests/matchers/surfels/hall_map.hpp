// The hall as a map.
#pragma once

#include <memory>
#include <utility>

#include "glocal/global_map.hpp"
#include "matchers/surfels/scanned_hall.hpp"

namespace glocal::test {

/// The hall as some lidars see it.
inline const std::shared_ptr<const GlobalMap>& hall_map() {
  static const auto map = [] {
    MapData data;
    data.resolution = 0.1;
    for (const Vector3& place : {Vector3{1.0, 5.0, 1.0}, Vector3{5.0, 3.0, 2.0}, Vector3{9.0, 1.5, 1.2},
                                 Vector3{10.5, 7.5, 2.5}, Vector3{12.8, 4.0, 1.0}, Vector3{5.0, 7.5, 1.8}}) {
      const Pose3 pose{place};
      const Points seen = moved(scan_of(hall(), pose), pose);
      for (std::size_t i = 0; i < seen.size(); ++i) data.points.push_back(seen[i]);
    }
    return std::make_shared<const GlobalMap>(std::move(data));
  }();
  return map;
}

}  // namespace glocal::test
