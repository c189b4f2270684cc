// A global map's points, to be drawn.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "glocal/points.hpp"

namespace glocal {

/// {"x", "y", "spacing_m"}: whole mm, each point once, and how far points lie apart.
[[nodiscard]] nlohmann::ordered_json map_points(const Points& points);

}  // namespace glocal
