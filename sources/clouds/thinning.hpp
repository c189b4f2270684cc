// Clouds with fewer points, whose times stay true.
#pragma once

#include <vector>

#include "glocal/points.hpp"

namespace glocal::clouds {

/// Puts the mean of each voxel's points (cubes of this side, m, above 0) in their place, and the mean of
/// their times, s; `times` are one for each point, or none.
void thin_out(Points& points, std::vector<float>& times, double side);

}  // namespace glocal::clouds
