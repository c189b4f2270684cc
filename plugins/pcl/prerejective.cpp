#include "prerejective.hpp"

#include <pcl/features/fpfh.h>
#include <pcl/registration/transformation_estimation_2D.h>

#include <Eigen/Eigenvalues>
#include <vector>

namespace glocal::pcl_plugin {
namespace {

using Normals = pcl::PointCloud<pcl::Normal>;
using Tree = pcl::search::KdTree<pcl::PointXYZ>;

/// Normals in the plane, by principal components of the neighbourhood; PCL's own would all point upwards.
Normals::Ptr normals_in_plane(const Cloud::Ptr& points, double radius) {
  Tree tree;
  tree.setInputCloud(points);
  auto result = std::make_shared<Normals>();
  pcl::Indices near;
  std::vector<float> squared_distances;
  for (const pcl::PointXYZ& point : *points) {
    tree.radiusSearch(point, radius, near, squared_distances);
    Eigen::Matrix2Xf neighbours(2, static_cast<Eigen::Index>(near.size()));
    for (std::size_t i = 0; i < near.size(); ++i) {
      const pcl::PointXYZ& p = (*points)[static_cast<std::size_t>(near[i])];
      neighbours.col(static_cast<Eigen::Index>(i)) << p.x, p.y;
    }
    neighbours.colwise() -= neighbours.rowwise().mean().eval();
    const Eigen::Matrix2f covariance = neighbours * neighbours.transpose();
    const Eigen::Vector2f normal =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix2f>(covariance).eigenvectors().col(0);
    result->push_back({normal.x(), normal.y(), 0.0F});
  }
  return result;
}

std::shared_ptr<Features> features(const Cloud::Ptr& points, const PclPrerejective::Params& params) {
  pcl::FPFHEstimation<pcl::PointXYZ, pcl::Normal, pcl::FPFHSignature33> estimation;
  estimation.setInputCloud(points);
  estimation.setInputNormals(normals_in_plane(points, params.normal_radius));
  estimation.setSearchMethod(std::make_shared<Tree>());
  estimation.setRadiusSearch(params.feature_radius);
  auto result = std::make_shared<Features>();
  estimation.compute(*result);
  return result;
}

}  // namespace

void describe(ParamVisitor& v, PclPrerejective::Params& p) {
  v.field("runs", p.runs, {.doc = "Independent searches in a step; each gives one pose at most.", .min = 1});
  describe_prerejection(v, p);
  v.field("normal_radius", p.normal_radius,
          {.doc = "Neighbourhood that gives a point's normal.", .unit = "m", .above = 0.0});
  v.field("feature_radius", p.feature_radius,
          {.doc = "Neighbourhood that gives a point's feature; must be larger.", .unit = "m", .above = 0.0});
  v.field("inlier_distance", p.inlier_distance,
          {.doc = "Distance at which a point counts as inlier.", .unit = "m", .above = 0.0});
  v.field("refinement", p.refinement, {.doc = "ICP from the poses found."});
  describe_contact_epsilon(v, p.contact_epsilon);
  v.removed("in_space", "in space the matcher pcl_cloud_prerejective searches, which has these keys itself");
  v.require(p.feature_radius > p.normal_radius, "feature_radius", "must be above normal_radius");
}

PclPrerejective::PclPrerejective(const Params& params, const StageSetup& setup)
    : params_(params),
      map_(cloud(setup.map->points())),
      map_features_(features(map_, params)),
      contact_(contact_index(*setup.map, "bitset", setup.epsilon(params.contact_epsilon))),
      aligner_(setup.map->points()) {}

MatchResult PclPrerejective::match(const MatchRequest& request, Rng& rng) {
  const LocalMap& local = request.local;
  if (local.points.size() < points_drawn) return {};
  const OwnRandomNumbers random_numbers(rng.next());
  const Cloud::Ptr source = cloud(local.points);
  Prerejection align;
  align.setTransformationEstimation(
      std::make_shared<pcl::registration::TransformationEstimation2D<pcl::PointXYZ, pcl::PointXYZ>>());
  align.setInputSource(source);
  align.setSourceFeatures(features(source, params_));
  align.setInputTarget(map_);
  align.setTargetFeatures(map_features_);
  set_up(align, params_, params_.inlier_distance);

  std::vector<Pose2> found;
  Cloud moved;
  for (int run = 0; run < params_.runs; ++run) {
    align.align(moved);
    if (align.hasConverged()) found.push_back(pose(align.getFinalTransformation()));
  }
  const std::vector<Pose2> refined = aligner_.align(local.points, found, params_.refinement, 1);
  MatchResult result;
  result.hypotheses = rated(refined, local, *contact_, request.omega_max);
  result.proposals = refined.size();
  result.points_tested = refined.size() * local.points.size();
  return result;
}

}  // namespace glocal::pcl_plugin
