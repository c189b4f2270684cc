#include "searches.hpp"

#include <omp.h>
#include <open3d/pipelines/registration/FastGlobalRegistration.h>
#include <open3d/pipelines/registration/Registration.h>
#include <open3d/utility/Random.h>

#include <Eigen/Geometry>
#include <mutex>
#include <stdexcept>

#include "glocal/voxel_filter.hpp"

namespace glocal::open3d_plugin {
namespace {

namespace registration = open3d::pipelines::registration;

/// Keeps OpenMP to the calling thread: how Open3D's threads share the random numbers is up to chance.
class SingleThread {
 public:
  SingleThread() : levels_(omp_get_max_active_levels()) { omp_set_max_active_levels(0); }
  ~SingleThread() { omp_set_max_active_levels(levels_); }
  SingleThread(const SingleThread&) = delete;
  SingleThread& operator=(const SingleThread&) = delete;

 private:
  int levels_;
};

/// Seeds Open3D's generator, of which there is one for the whole program: until this is gone, whoever else
/// wants to draw waits.
class OwnRandomNumbers {
 public:
  explicit OwnRandomNumbers(std::uint64_t seed) : lock_(mutex()) {
    open3d::utility::random::Seed(static_cast<int>(seed & 0x7fffffffU));
  }

 private:
  static std::mutex& mutex() {
    static std::mutex one;
    return one;
  }

  std::lock_guard<std::mutex> lock_;
};

Pose3 pose_of(const Eigen::Matrix4d& matrix) {
  return {matrix.topRightCorner<3, 1>(), Quaternion(matrix.topLeftCorner<3, 3>()).normalized()};
}

/// The same measure for every search.
MatchedPose judged(const Open3dCloud& source, const Open3dCloud& target, double voxel_size,
                   const Eigen::Matrix4d& target_from_source) {
  constexpr double voxels = 1.5;
  const registration::RegistrationResult result = registration::EvaluateRegistration(
      source.points, target.points, voxels * voxel_size, target_from_source);
  return {pose_of(target_from_source), result.fitness_, result.inlier_rmse_};
}

}  // namespace

Open3dCloud::Open3dCloud(const Points& all, double voxel_size, const Vector3& normals_towards) {
  constexpr double normal_voxels = 2.0;
  constexpr int normal_neighbours = 30;
  constexpr double feature_voxels = 5.0;
  constexpr int feature_neighbours = 100;
  const Points means = voxel_downsampled(all, voxel_size);
  for (std::size_t i = 0; i < means.size(); ++i) {
    const Point p = means[i];
    points.points_.emplace_back(p.x, p.y, p.z);
  }
  if (size() < fewest_points) return;
  const SingleThread single_thread;
  points.EstimateNormals(
      open3d::geometry::KDTreeSearchParamHybrid(normal_voxels * voxel_size, normal_neighbours));
  points.OrientNormalsTowardsCameraLocation(normals_towards);
  features = *registration::ComputeFPFHFeature(
      points, open3d::geometry::KDTreeSearchParamHybrid(feature_voxels * voxel_size, feature_neighbours));
}

void describe(ParamVisitor& v, RansacSearch& p) {
  v.field("iterations", p.iterations, {.doc = "Triples drawn at most.", .min = 1, .max = 1e9});
  v.field("confidence", p.confidence,
          {.doc = "Ends sooner once the best pose is right with this probability.",
           .min = 0.0,
           .max = 1.0,
           .audience = Audience::expert});
  v.field("edge_length", p.edge_length,
          {.doc = "Triples whose sides are less alike (shorter by longer one) are rejected.",
           .min = 0.0,
           .max = 1.0,
           .audience = Audience::expert});
  v.field("inlier_distance", p.inlier_distance,
          {.doc = "Up to what distance two points correspond, in voxels.",
           .above = 0.0,
           .audience = Audience::expert});
}

std::optional<MatchedPose> RansacSearch::find(const Open3dCloud& source, const Open3dCloud& target,
                                              double voxel_size, std::uint64_t seed) const {
  if (source.size() < fewest_points || target.size() < fewest_points) return std::nullopt;
  constexpr int drawn = 3;
  const double distance = inlier_distance * voxel_size;
  const registration::CorrespondenceCheckerBasedOnEdgeLength sides(edge_length);
  const registration::CorrespondenceCheckerBasedOnDistance distances(distance);
  const SingleThread single_thread;
  const OwnRandomNumbers random_numbers(seed);
  const registration::RegistrationResult found = registration::RegistrationRANSACBasedOnFeatureMatching(
      source.points, target.points, source.features, target.features, true, distance,
      registration::TransformationEstimationPointToPoint(false), drawn, {sides, distances},
      registration::RANSACConvergenceCriteria(iterations, confidence));
  if (found.correspondence_set_.empty()) return std::nullopt;
  return judged(source, target, voxel_size, found.transformation_);
}

void describe(ParamVisitor& v, FastGlobalSearch& p) {
  v.field("iterations", p.iterations, {.doc = "Iterations at most.", .min = 1, .max = 1e6});
  v.field(
      "tuples", p.tuples,
      {.doc = "Triples of correspondences at most.", .min = 10, .max = 1e6, .audience = Audience::expert});
  v.field("tuple_scale", p.tuple_scale,
          {.doc = "Triples whose sides are less alike (shorter by longer one) are rejected.",
           .min = 0.01,
           .max = 1.0,
           .audience = Audience::expert});
  v.field("inlier_distance", p.inlier_distance,
          {.doc = "Up to what distance two points correspond in the end, in voxels.",
           .above = 0.0,
           .audience = Audience::expert});
}

std::optional<MatchedPose> FastGlobalSearch::find(const Open3dCloud& source, const Open3dCloud& target,
                                                  double voxel_size, std::uint64_t seed) const {
  if (source.size() < fewest_points || target.size() < fewest_points) return std::nullopt;
  registration::FastGlobalRegistrationOption option;
  option.maximum_correspondence_distance_ = inlier_distance * voxel_size;
  option.iteration_number_ = iterations;
  option.tuple_scale_ = tuple_scale;
  option.maximum_tuple_count_ = tuples;
  const SingleThread single_thread;
  const OwnRandomNumbers random_numbers(seed);
  try {
    const Eigen::Matrix4d found = registration::FastGlobalRegistrationBasedOnFeatureMatching(
                                      source.points, target.points, source.features, target.features, option)
                                      .transformation_;
    // What it gives where it has found nothing.
    if (found == Eigen::Matrix4d::Identity()) return std::nullopt;
    return judged(source, target, voxel_size, found);
  } catch (const std::runtime_error&) {
    // It draws from an empty list where no two points have like features.
    return std::nullopt;
  }
}

}  // namespace glocal::open3d_plugin
