#include "sources/clouds/point_cloud_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "glocal/evenly.hpp"
#include "glocal/voxel_filter.hpp"
#include "sources/clouds/cloud_file.hpp"
#include "sources/clouds/trajectory_file.hpp"

namespace glocal::clouds {
namespace {

/// The normal of the first point of each voxel: the mean of a thin wall's two sides would be none.
Points first_normals(const Points& normals, const VoxelGroups& groups) {
  Points firsts;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    if (groups.of_point[i] == firsts.size()) firsts.push_back(normals[i]);
  }
  return firsts;
}

/// m^2; infinite if all points are in the same place.
float nearest_squared(const Points& points, const Point& p) {
  constexpr float none = std::numeric_limits<float>::infinity();
  float nearest = none;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float dx = points.x[i] - p.x, dy = points.y[i] - p.y, dz = points.z[i] - p.z;
    const float squared = dx * dx + dy * dy + dz * dz;
    nearest = std::min(nearest, squared > 0.0F ? squared : none);
  }
  return nearest;
}

}  // namespace

void describe(ParamVisitor& v, PointCloudMap::Params& p) {
  v.field("path", p.path,
          {.doc = "Cloud of points: PCD, PLY, KITTI (*.bin) or the occupied voxels of OctoMap's *.bt; plain, "
                  "gzip, bzip2 or xz.",
           .required = true});
  describe_cloud_unit(v, p.unit);
  v.field(
      "voxel_size", p.voxel_size,
      {.doc = "Side of the cubes whose points are replaced by their mean; 0 takes all points as they are.",
       .unit = "m",
       .min = 0.0,
       .max = 100.0,
       .audience = Audience::tuner});
  v.field("trajectory", p.trajectory,
          {.doc = "Poses of the robot that recorded the map (TUM or KITTI): trials start near them; without, "
                  "near the map's points."});
}

PointCloudMap::PointCloudMap(const Params& params, const SourceSetup& setup)
    : params_(params), motion_(setup.motion), warn_(setup.warn) {
  setup.note_input(params.path.resolved);
  if (!params.trajectory.text.empty()) setup.note_input(params.trajectory.resolved);
}

MapData PointCloudMap::load() {
  Cloud cloud = read_cloud(params_.path.resolved, {.unit = params_.unit, .map_motion = motion_});
  for (const std::string& remark : cloud_remarks(cloud))
    warn_(params_.path.resolved.string() + ": " + remark);
  MapData map;
  map.origin = cloud.origin;
  if (params_.voxel_size > 0.0) {
    const VoxelGroups groups = voxel_groups(cloud.points, params_.voxel_size);
    map.points = means_of_groups(cloud.points, groups);
    map.normals = first_normals(cloud.normals, groups);
    map.resolution = params_.voxel_size;
  } else {
    map.points = std::move(cloud.points);
    map.normals = std::move(cloud.normals);
    map.resolution = cloud.voxel_size > 0.0 ? cloud.voxel_size : typical_spacing(map.points);
  }
  if (!params_.trajectory.text.empty()) {
    for (const StampedPose& pose : read_trajectory(params_.trajectory.resolved).poses)
      map.path.push_back(shifted(pose.pose, -map.origin));
  }
  return map;
}

double typical_spacing(const Points& points) {
  constexpr std::size_t most_samples = 200, distances = 50'000'000;
  const std::size_t samples = std::clamp<std::size_t>(distances / points.size(), 20, most_samples);
  std::vector<float> squared;
  for (const std::size_t i : evenly_chosen(points.size(), samples))
    squared.push_back(nearest_squared(points, points[i]));
  const auto middle = squared.begin() + static_cast<std::ptrdiff_t>(squared.size() / 2);
  std::nth_element(squared.begin(), middle, squared.end());
  return std::isfinite(*middle) ? std::sqrt(static_cast<double>(*middle)) : 0.0;
}

}  // namespace glocal::clouds
