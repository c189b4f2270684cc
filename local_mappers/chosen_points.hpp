// Some of many points.
#pragma once

#include <vector>

#include "glocal/points.hpp"

namespace glocal::local_mappers {

/// Those whose flag is set, in their order; there is a flag for each.
[[nodiscard]] inline Points chosen_points(const Points& points, const std::vector<bool>& is_chosen) {
  Points chosen;
  for (std::size_t i = 0; i < is_chosen.size(); ++i) {
    if (is_chosen[i]) chosen.push_back(points[i]);
  }
  return chosen;
}

}  // namespace glocal::local_mappers
