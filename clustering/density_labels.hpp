// Density-based clusters of poses.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "glocal/pose3.hpp"
#include "glocal/pose_tolerance.hpp"

namespace glocal::clustering {

/// DBSCAN (Ester, Kriegel, Sander and Xu 1996): a pose is a core if those near it, itself included, weigh
/// `min_weight` or more; cores near each other are in one cluster, and so are poses near a core. A pose near
/// cores of several clusters goes to the one with the first core of all, as if poses were taken one after the
/// other. A pose near none is alone. Returns for each pose the index of one of its cluster, the same for all
/// of them.
///
/// All poses in a cell whose diagonal is the radius are near each other (Gunawan 2013), so that crowds do not
/// cost the square of their number. In space groups around a pose, of half the radius, stand in for cells.
[[nodiscard]] std::vector<std::size_t> density_labels(std::span<const Pose2> poses,
                                                      std::span<const double> weights,
                                                      const PoseTolerance& radius, double min_weight);
[[nodiscard]] std::vector<std::size_t> density_labels(std::span<const Pose3> poses,
                                                      std::span<const double> weights,
                                                      const PoseTolerance& radius, double min_weight);

}  // namespace glocal::clustering
