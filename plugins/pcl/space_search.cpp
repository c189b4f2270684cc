#include "space_search.hpp"

#include <pcl/features/fpfh.h>
#include <pcl/features/normal_3d.h>
#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/search/kdtree.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "glocal/voxel_filter.hpp"
#include "prerejection.hpp"

namespace glocal::pcl_plugin {
namespace {

using Tree = pcl::search::KdTree<pcl::PointXYZ>;

Pose3 pose_in_space(const Eigen::Matrix4f& matrix) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(matrix.topLeftCorner<3, 3>().cast<double>()).normalized();
  return {{matrix(0, 3), matrix(1, 3), matrix(2, 3)}, {q.w(), q.x(), q.y(), q.z()}};
}

/// How well a cloud lies on another one; `moved` is in the other's frame.
MatchedPose judged(const Pose3& pose, const Cloud& moved, const Cloud::Ptr& target, double voxel_size) {
  constexpr double voxels = 1.5;
  const double reach = voxels * voxel_size;
  pcl::KdTreeFLANN<pcl::PointXYZ> tree;
  tree.setInputCloud(target);
  pcl::Indices nearest(1);
  std::vector<float> squared_distance(1);
  std::size_t near = 0;
  double sum = 0.0;
  for (const pcl::PointXYZ& point : moved) {
    tree.nearestKSearch(point, 1, nearest, squared_distance);
    const double squared = squared_distance.front();
    if (squared >= reach * reach) continue;
    ++near;
    sum += squared;
  }
  if (near == 0) return {pose};
  return {pose, static_cast<double>(near) / static_cast<double>(moved.size()),
          std::sqrt(sum / static_cast<double>(near))};
}

}  // namespace

FpfhCloud::FpfhCloud(const Points& all, double voxel_size, const Vector3& normals_towards)
    : points(std::make_shared<Cloud>()), features(std::make_shared<Features>()) {
  constexpr double normal_voxels = 2.0;
  constexpr double feature_voxels = 5.0;
  const Cloud::Ptr means = cloud(voxel_downsampled(all, voxel_size));
  pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> normal_estimation;
  normal_estimation.setInputCloud(means);
  normal_estimation.setSearchMethod(std::make_shared<Tree>());
  normal_estimation.setRadiusSearch(normal_voxels * voxel_size);
  normal_estimation.setViewPoint(static_cast<float>(normals_towards.x()),
                                 static_cast<float>(normals_towards.y()),
                                 static_cast<float>(normals_towards.z()));
  pcl::PointCloud<pcl::Normal> all_normals;
  normal_estimation.compute(all_normals);
  const auto normals = std::make_shared<pcl::PointCloud<pcl::Normal>>();
  for (std::size_t i = 0; i < means->size(); ++i) {
    if (!std::isfinite(all_normals[i].normal_x)) continue;
    points->push_back((*means)[i]);
    normals->push_back(all_normals[i]);
  }
  if (size() < fewest_points) return;
  pcl::FPFHEstimation<pcl::PointXYZ, pcl::Normal, pcl::FPFHSignature33> feature_estimation;
  feature_estimation.setInputCloud(points);
  feature_estimation.setInputNormals(normals);
  feature_estimation.setSearchMethod(std::make_shared<Tree>());
  feature_estimation.setRadiusSearch(feature_voxels * voxel_size);
  feature_estimation.compute(*features);
}

void describe(ParamVisitor& v, PrerejectiveSearch& p) {
  describe_prerejection(v, p);
  v.field("inlier_distance", p.inlier_distance,
          {.doc = "Distance at which a point counts as inlier, in voxels.", .above = 0.0});
}

std::optional<MatchedPose> PrerejectiveSearch::find(const FpfhCloud& source, const FpfhCloud& target,
                                                    double voxel_size, std::uint64_t seed) const {
  if (source.size() < fewest_points || target.size() < fewest_points) return std::nullopt;
  const OwnRandomNumbers random_numbers(seed);
  Prerejection align;
  align.setInputSource(source.points);
  align.setSourceFeatures(source.features);
  align.setInputTarget(target.points);
  align.setTargetFeatures(target.features);
  set_up(align, *this, inlier_distance * voxel_size);
  pcl::PointCloud<pcl::PointXYZ> moved;
  align.align(moved);
  if (!align.hasConverged()) return std::nullopt;
  return judged(pose_in_space(align.getFinalTransformation()), moved, target.points, voxel_size);
}

}  // namespace glocal::pcl_plugin
