#include "glocal/cloud_resolution.hpp"

#include <algorithm>

#include "glocal/voxel_filter.hpp"

namespace glocal {
namespace {

constexpr double per_octave = 4.0;

double side_of(int power) {
  return std::exp2(static_cast<double>(power) / per_octave);
}

/// The smallest power that is coarse enough, by bisection: the coarser, the fewer voxels have points.
int fitting_power(const Points& cloud) {
  constexpr double points_per_voxel = 3.8;
  constexpr double most_voxels = 8000.0;
  int too_fine = -40;      // 1 mm
  int coarse_enough = 40;  // 1 km
  const double limit = std::min(static_cast<double>(cloud.size()) / points_per_voxel, most_voxels);
  while (coarse_enough - too_fine > 1) {
    const int middle = (too_fine + coarse_enough) / 2;
    const auto voxels = static_cast<double>(voxel_groups(cloud, side_of(middle)).count);
    (voxels > limit ? too_fine : coarse_enough) = middle;
  }
  return coarse_enough;
}

}  // namespace

float cloud_resolution(const Points& a, const Points& b) {
  const double of_a = fitting_power(a);
  const double of_b = fitting_power(b);
  // A map is larger than a scan, and would be too coarse for it.
  constexpr double most_above_finer = per_octave / 2.0;
  const double power = std::min((of_a + of_b) / 2.0, std::min(of_a, of_b) + most_above_finer);
  return static_cast<float>(std::exp2(power / per_octave));
}

double map_voxel_size(double resolution) {
  constexpr double points_apart = 3.0;
  constexpr double finest = 0.1;
  return std::max(points_apart * resolution, finest);
}

}  // namespace glocal
