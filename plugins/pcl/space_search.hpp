// Random samples of points with like features, in space.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "clouds.hpp"
#include "glocal/params.hpp"
#include "plugins/common/matched_pose.hpp"
#include "prerejection.hpp"

namespace glocal::pcl_plugin {

/// A cloud, one point for each voxel, with FPFH features in the sizes of PCL's tutorial: normals from 2
/// voxels around, features from 5. Points with too few others around them for a normal are left out.
struct FpfhCloud {
  /// Normals are turned towards a place (in the cloud's frame, m): that of the sensor, where there is one.
  FpfhCloud(const Points& all, double voxel_size, const Vector3& normals_towards);

  [[nodiscard]] std::size_t size() const { return points->size(); }
  /// Of the features.
  [[nodiscard]] std::size_t memory_bytes() const { return features->size() * sizeof(pcl::FPFHSignature33); }

  Cloud::Ptr points;  ///< m
  std::shared_ptr<Features> features;
};

/// pcl::SampleConsensusPrerejective (Buch et al. 2013): triples of points with like features, rejected early
/// where their sides differ. Defaults are those of PCL's tutorial.
struct PrerejectiveSearch {
  using Cloud = FpfhCloud;

  int iterations = 50000;
  int candidates = 5;
  double similarity = 0.9;
  double inlier_distance = 2.5;
  double inlier_fraction = 0.25;

  /// None if no pose has enough inliers.
  [[nodiscard]] std::optional<MatchedPose> find(const FpfhCloud& source, const FpfhCloud& target,
                                                double voxel_size, std::uint64_t seed) const;
};
void describe(ParamVisitor& v, PrerejectiveSearch& p);

}  // namespace glocal::pcl_plugin
