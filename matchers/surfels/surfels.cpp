#include "matchers/surfels/surfels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "glocal/point_spread.hpp"
#include "matchers/surfels/voxel_table.hpp"

namespace glocal::surfels {
namespace {

/// Voxels with points, and the mean of each.
struct FilledVoxels {
  VoxelTable numbers;
  Points means;
};

FilledVoxels filled_voxels(const Points& cloud, float side, int margin) {
  FilledVoxels filled{VoxelTable(VoxelRegion(cloud, side, margin)), {}};
  std::vector<float> counts;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    std::uint32_t& number = filled.numbers.slot(filled.numbers.voxel_of(cloud[i]));
    if (number == VoxelTable::none) {
      number = static_cast<std::uint32_t>(counts.size());
      counts.push_back(0.0F);
      filled.means.push_back({});
    }
    counts[number] += 1.0F;
    filled.means.x[number] += cloud.x[i];
    filled.means.y[number] += cloud.y[i];
    filled.means.z[number] += cloud.z[i];
  }
  for (std::size_t k = 0; k < counts.size(); ++k) filled.means.set(k, (1.0F / counts[k]) * filled.means[k]);
  return filled;
}

/// The normal at a voxel from the means within so many voxels.
std::optional<Point> normal_within(const FilledVoxels& filled, std::size_t k, float voxels) {
  const Point p = filled.means[k];
  const Voxel centre = filled.numbers.voxel_of(p);
  const auto reach = static_cast<std::int32_t>(std::ceil(voxels));
  const float radius = voxels * filled.numbers.side();
  constexpr float fewest = 5.0F;
  constexpr float thinnest_width = 0.04F;
  constexpr float thickest = 0.35F;
  PointSums<float> sums;
  for (std::int32_t z = centre.z - reach; z <= centre.z + reach; ++z) {
    for (std::int32_t y = centre.y - reach; y <= centre.y + reach; ++y) {
      for (std::int32_t x = centre.x - reach; x <= centre.x + reach; ++x) {
        const std::uint32_t neighbour = filled.numbers.at(Voxel{x, y, z});
        if (neighbour == VoxelTable::none) continue;
        const Point offset = filled.means[neighbour] - p;
        if (dot(offset, offset) <= radius * radius) sums.add(offset.x, offset.y, offset.z);
      }
    }
  }
  return sums.size() < fewest ? std::nullopt : sums.plane_normal(thinnest_width, thickest);
}

/// The mean of a voxel's points, moved along the normal to the mean of the voxels around it: where voxels cut
/// a surface of some thickness along it, their own means are beside it.
Point on_surface(const FilledVoxels& filled, std::size_t k, const Point& normal) {
  constexpr float voxels = 1.5F;
  const Point p = filled.means[k];
  const Voxel centre = filled.numbers.voxel_of(p);
  const float radius = voxels * filled.numbers.side();
  float sum = 0.0F;
  float n = 0.0F;
  for (std::int32_t z = centre.z - 1; z <= centre.z + 1; ++z) {
    for (std::int32_t y = centre.y - 1; y <= centre.y + 1; ++y) {
      for (std::int32_t x = centre.x - 1; x <= centre.x + 1; ++x) {
        const std::uint32_t neighbour = filled.numbers.at(Voxel{x, y, z});
        if (neighbour == VoxelTable::none) continue;
        const Point offset = filled.means[neighbour] - p;
        if (dot(offset, offset) > radius * radius) continue;
        sum += dot(offset, normal);
        n += 1.0F;
      }
    }
  }
  return p + (sum / n) * normal;
}

/// Directions in equal parts of a cube's faces.
std::size_t direction_bin(const Point& n) {
  constexpr float parts = 6.0F;
  const float ax = std::abs(n.x);
  const float ay = std::abs(n.y);
  const float az = std::abs(n.z);
  const auto part = [&](float v, float most) {
    return static_cast<std::size_t>(std::min((v / most + 1.0F) * 0.5F * parts, parts - 1.0F));
  };
  const auto bin = [&](std::size_t face, float u, float v, float most) {
    return (face * 6 + part(u, most)) * 6 + part(v, most);
  };
  if (ax >= ay && ax >= az) return bin(n.x > 0.0F ? 0 : 1, n.y, n.z, ax);
  if (ay >= az) return bin(n.y > 0.0F ? 2 : 3, n.x, n.z, ay);
  return bin(n.z > 0.0F ? 4 : 5, n.x, n.y, az);
}

/// Weights of surfels with these normals: 1 / sqrt(how many share the direction), scaled.
std::vector<float> balanced_weights(const Points& normals) {
  std::array<float, std::size_t{6} * 36> counts{};
  for (std::size_t i = 0; i < normals.size(); ++i) counts[direction_bin(normals[i])] += 1.0F;
  std::vector<float> weights(normals.size());
  float sum = 0.0F;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    weights[i] = 1.0F / std::sqrt(counts[direction_bin(normals[i])]);
    sum += weights[i];
  }
  for (float& weight : weights) weight *= static_cast<float>(normals.size()) / sum;
  return weights;
}

}  // namespace

Points points_in_view(const LocalMap& local, float voxel_size) {
  const float farthest = std::min(500.0F, 2000.0F * voxel_size);
  const Point robot = as_point(local.local_from_robot.translation());
  Points near;
  near.reserve(local.points.size());
  for (std::size_t i = 0; i < local.points.size(); ++i) {
    if (length(local.points[i] - robot) <= farthest) near.push_back(local.points[i]);
  }
  return near;
}

Surfels surfels_of(const Points& cloud, float voxel_size, const std::optional<Point>& seen_from) {
  constexpr float near = 2.5F;
  constexpr float far = 5.0F;
  const FilledVoxels filled = filled_voxels(cloud, voxel_size, 1);
  Surfels surfels;
  for (std::size_t k = 0; k < filled.means.size(); ++k) {
    auto normal = normal_within(filled, k, near);
    if (!normal) normal = normal_within(filled, k, far);
    if (!normal) continue;
    const Point p = filled.means[k];
    if (seen_from && dot(*normal, *seen_from - p) < 0.0F) normal = -1.0F * *normal;
    surfels.points.push_back(on_surface(filled, k, *normal));
    surfels.normals.push_back(*normal);
  }
  surfels.weights = balanced_weights(surfels.normals);
  return surfels;
}

}  // namespace glocal::surfels
