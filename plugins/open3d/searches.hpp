// Clouds as Open3D's global registration takes them, and what it makes of two of them.
#pragma once

#include <open3d/geometry/PointCloud.h>
#include <open3d/pipelines/registration/Feature.h>

#include <cstddef>
#include <cstdint>
#include <optional>

#include "glocal/params.hpp"
#include "glocal/points.hpp"
#include "glocal/pose3.hpp"
#include "plugins/common/matched_pose.hpp"

namespace glocal::open3d_plugin {

/// A cloud, one point for each voxel, with FPFH features (Rusu, Blodow and Beetz 2009) in the sizes of
/// Open3D's tutorial: normals from 2 voxels around, features from 5.
struct Open3dCloud {
  /// Normals are turned towards a place (in the cloud's frame, m): that of the sensor, where there is one.
  Open3dCloud(const Points& all, double voxel_size, const Vector3& normals_towards);

  [[nodiscard]] std::size_t size() const { return points.points_.size(); }
  /// Of the features.
  [[nodiscard]] std::size_t memory_bytes() const {
    return static_cast<std::size_t>(features.data_.size()) * sizeof(double);
  }

  open3d::geometry::PointCloud points;                ///< m, with unit normals.
  open3d::pipelines::registration::Feature features;  ///< 33 numbers for each point.
};

/// Random sample consensus of points with like features. Defaults are those of Open3D's tutorial.
struct RansacSearch {
  using Cloud = Open3dCloud;

  int iterations = 100000;
  double confidence = 0.999;
  double edge_length = 0.9;
  double inlier_distance = 1.5;

  /// None if no three points agree. Takes one thread.
  [[nodiscard]] std::optional<MatchedPose> find(const Open3dCloud& source, const Open3dCloud& target,
                                                double voxel_size, std::uint64_t seed) const;
};
void describe(ParamVisitor& v, RansacSearch& p);

/// Fast Global Registration (Zhou, Park and Koltun 2016). Defaults are those of Open3D's tutorial.
struct FastGlobalSearch {
  using Cloud = Open3dCloud;

  int iterations = 64;
  int tuples = 1000;
  double tuple_scale = 0.95;
  double inlier_distance = 0.5;

  /// None if fewer than ten points have like features. Takes one thread.
  [[nodiscard]] std::optional<MatchedPose> find(const Open3dCloud& source, const Open3dCloud& target,
                                                double voxel_size, std::uint64_t seed) const;
};
void describe(ParamVisitor& v, FastGlobalSearch& p);

}  // namespace glocal::open3d_plugin
