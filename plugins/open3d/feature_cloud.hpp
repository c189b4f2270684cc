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

namespace glocal {

/// Clouds with fewer points, one for each voxel, are not registered.
inline constexpr std::size_t fewest_points = 10;

/// A cloud, one point for each voxel, with FPFH features (Rusu, Blodow and Beetz 2009) in the sizes of
/// Open3D's tutorial: normals from 2 voxels around, features from 5.
struct FeatureCloud {
  /// Normals are turned towards a place (in the cloud's frame, m): that of the sensor, where there is one.
  FeatureCloud(const Points& all, double voxel_size, const Vector3& normals_towards);

  [[nodiscard]] std::size_t size() const { return points.points_.size(); }

  open3d::geometry::PointCloud points;                ///< m, with unit normals.
  open3d::pipelines::registration::Feature features;  ///< 33 numbers for each point.
};

/// The pose of one cloud in another.
struct MatchedPose {
  Pose3 target_from_source;
  double overlap = 0.0;  ///< Share of the source's points within 1.5 voxels of the target's, in [0, 1].
  double rmse = 0.0;     ///< Of these points' distances, m.
};

/// Random sample consensus of points with like features. Defaults are those of Open3D's tutorial.
struct RansacSearch {
  int iterations = 100000;
  double confidence = 0.999;
  double edge_length = 0.9;
  double inlier_distance = 1.5;

  /// None if no three points agree. Takes one thread.
  [[nodiscard]] std::optional<MatchedPose> find(const FeatureCloud& source, const FeatureCloud& target,
                                              double voxel_size, std::uint64_t seed) const;
};
void describe(ParamVisitor& v, RansacSearch& p);

/// Fast Global Registration (Zhou, Park and Koltun 2016). Defaults are those of Open3D's tutorial.
struct FastGlobalSearch {
  int iterations = 64;
  int tuples = 1000;
  double tuple_scale = 0.95;
  double inlier_distance = 0.5;

  /// None if fewer than ten points have like features. Takes one thread.
  [[nodiscard]] std::optional<MatchedPose> find(const FeatureCloud& source, const FeatureCloud& target,
                                              double voxel_size, std::uint64_t seed) const;
};
void describe(ParamVisitor& v, FastGlobalSearch& p);

}  // namespace glocal
