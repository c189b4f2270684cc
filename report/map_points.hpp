// A global map's points, to be drawn.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "glocal/points.hpp"
#include "glocal/pose3.hpp"

namespace glocal {

/// {"x", "y", "spacing_m"}: whole mm, each point once, and how far points lie apart. In space with "z", and
/// at most 150,000 of them (thinned_in_space). They are in the map's frame, `points` relative to its origin.
[[nodiscard]] nlohmann::ordered_json map_points(const Points& points,
                                                const Vector3& origin = Vector3::Zero());

}  // namespace glocal
