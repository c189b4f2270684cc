// Clouds of points in space as a report has them: no more points than can be seen.
#pragma once

#include <cstddef>

#include "glocal/points.hpp"

namespace glocal {

/// The same points where all of them have the height 0, or where there are at most so many. Else the first
/// point of each voxel, whose side is the smallest of 0.02 m, 0.02 √2 m, 0.04 m … that leaves at most so
/// many.
[[nodiscard]] Points thinned_in_space(const Points& points, std::size_t most);

}  // namespace glocal
