#include "glocal/voxel_filter.hpp"

#include <array>
#include <bit>

namespace glocal {
namespace {

using Voxel = std::array<std::int64_t, 3>;

/// Without the call to the library that std::floor is on older processors.
std::int64_t rounded_down(double value) {
  const auto towards_zero = static_cast<std::int64_t>(value);
  return static_cast<double>(towards_zero) > value ? towards_zero - 1 : towards_zero;
}

std::uint64_t hash_of(const Voxel& voxel) {
  std::uint64_t hash = 0;
  for (const std::int64_t index : voxel)
    hash = (hash ^ static_cast<std::uint64_t>(index)) * 0x9E3779B97F4A7C15U;
  return hash;
}

/// Numbers voxels as they come: a table with open addressing, at most half full.
class VoxelNumbers {
 public:
  explicit VoxelNumbers(std::size_t most)
      : shift_(64 - bits_for(most)), slots_(std::size_t{1} << bits_for(most)) {}

  std::uint32_t number_of(const Voxel& voxel) {
    std::size_t at = hash_of(voxel) >> shift_;  // The upper bits of a product are the well mixed ones.
    for (; slots_[at] != 0; at = at + 1 == slots_.size() ? 0 : at + 1) {
      if (voxels_[slots_[at] - 1] == voxel) return slots_[at] - 1;
    }
    voxels_.push_back(voxel);
    slots_[at] = static_cast<std::uint32_t>(voxels_.size());
    return slots_[at] - 1;
  }
  [[nodiscard]] std::size_t count() const { return voxels_.size(); }

 private:
  static int bits_for(std::size_t most) { return static_cast<int>(std::bit_width(2 * most + 1)); }

  int shift_;
  std::vector<std::uint32_t> slots_;  ///< Number of the voxel there, from 1; 0 if there is none.
  std::vector<Voxel> voxels_;
};

}  // namespace

VoxelGroups voxel_groups(const Points& points, double side) {
  VoxelNumbers numbers(points.size());
  VoxelGroups groups;
  groups.of_point.reserve(points.size());
  const double per_metre = 1.0 / side;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point p = points[i];
    groups.of_point.push_back(numbers.number_of(
        {rounded_down(p.x * per_metre), rounded_down(p.y * per_metre), rounded_down(p.z * per_metre)}));
  }
  groups.count = numbers.count();
  return groups;
}

Points means_of_groups(const Points& points, const VoxelGroups& groups) {
  struct Sum {
    double x = 0.0, y = 0.0, z = 0.0, points = 0.0;
  };
  std::vector<Sum> sums(groups.count);
  for (std::size_t i = 0; i < points.size(); ++i) {
    Sum& sum = sums[groups.of_point[i]];
    sum.x += points.x[i];
    sum.y += points.y[i];
    sum.z += points.z[i];
    sum.points += 1.0;
  }
  Points means;
  means.reserve(groups.count);
  for (const Sum& sum : sums)
    means.push_back({static_cast<float>(sum.x / sum.points), static_cast<float>(sum.y / sum.points),
                     static_cast<float>(sum.z / sum.points)});
  return means;
}

}  // namespace glocal
