#include "sources/clouds/thinning.hpp"

#include "glocal/voxel_filter.hpp"

namespace glocal::clouds {
namespace {

/// The mean of each group's times. To first order it is when the mean of the group's points was measured.
std::vector<float> mean_times(const std::vector<float>& times, const VoxelGroups& groups) {
  std::vector<double> sums(groups.count, 0.0);
  std::vector<double> counts(groups.count, 0.0);
  for (std::size_t i = 0; i < times.size(); ++i) {
    sums[groups.of_point[i]] += times[i];
    counts[groups.of_point[i]] += 1.0;
  }
  std::vector<float> means(groups.count);
  for (std::size_t i = 0; i < groups.count; ++i) means[i] = static_cast<float>(sums[i] / counts[i]);
  return means;
}

}  // namespace

void thin_out(Points& points, std::vector<float>& times, double side) {
  const VoxelGroups groups = voxel_groups(points, side);
  points = means_of_groups(points, groups);
  if (!times.empty()) times = mean_times(times, groups);
}

}  // namespace glocal::clouds
