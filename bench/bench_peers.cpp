// The same task for glocal's matcher and for what PCL offers: one local map, one global map, no idea where.
// Built only where PCL is installed.
#include <benchmark/benchmark.h>
#include <pcl/features/fpfh.h>
#include <pcl/point_types.h>
#include <pcl/registration/icp.h>
#include <pcl/registration/sample_consensus_prerejective.h>
#include <pcl/registration/transformation_estimation_2D.h>
#include <pcl/search/kdtree.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/scenes.hpp"
#include "glocal/contact.hpp"

namespace glocal::bench {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Normals = pcl::PointCloud<pcl::Normal>;
using Features = pcl::PointCloud<pcl::FPFHSignature33>;

constexpr double epsilon = 0.10;

/// The local map a robot has after so many key frames from each start of the experiment.
struct Task {
  LocalMap local;
  Pose2 map_from_robot;  ///< The truth.
};

std::vector<Task> tasks(const Scene& scene, std::size_t step) {
  std::vector<Task> result;
  for (const std::size_t start : scene.prepared.starts) {
    result.push_back({local_map_at(scene, start, step),
                      scene.prepared.drive.samples[start + step].map_from_robot.value()});
  }
  return result;
}

/// One pass over all tasks with `answer(local map)`, a robot pose; counts those within the experiment's
/// limits.
template <class Answer>
void run_tasks(benchmark::State& state, const Scene& scene, Answer answer) {
  const std::vector<Task> all = tasks(scene, static_cast<std::size_t>(state.range(0)));
  const EvaluationConfig& limits = scene.experiment.evaluation;
  std::size_t right = 0;
  for ([[maybe_unused]] auto _ : state) {
    right = 0;
    for (const Task& task : all) {
      const std::optional<Pose2> pose = answer(task.local);
      if (pose && distance(*pose, task.map_from_robot) <= limits.max_translation_error &&
          rotation_between(*pose, task.map_from_robot) <= radians(limits.max_rotation_error_deg)) {
        ++right;
      }
    }
  }
  state.counters["right"] = static_cast<double>(right);
  state.counters["of"] = static_cast<double>(all.size());
  state.counters["per_match"] = time_per_item(static_cast<double>(all.size()));
}

// --- glocal --------------------------------------------------------------------------------------------

void glocal_ransam(benchmark::State& state) {
  constexpr double omega_max = 0.5;
  const Scene& s = scene("intel");
  const auto matcher = make_matcher(s, s.prepared.map, 1);
  Rng rng(1);
  run_tasks(state, s, [&](const LocalMap& local) -> std::optional<Pose2> {
    const MatchResult result = matcher->match(local, {}, omega_max, rng);
    if (result.hypotheses.empty()) return std::nullopt;
    return result.hypotheses.front().map_from_robot;
  });
}

// --- PCL -----------------------------------------------------------------------------------------------

Cloud::Ptr cloud(const Points& points) {
  auto result = std::make_shared<Cloud>();
  for (std::size_t i = 0; i < points.size(); ++i) result->push_back({points.x[i], points.y[i], 0.0F});
  return result;
}

Pose2 pose_of(const Eigen::Matrix4f& m) {
  return {m(0, 3), m(1, 3), std::atan2(m(1, 0), m(0, 0))};
}

/// Normals in the plane, by principal components of the neighbourhood; PCL's own would all point upwards.
Normals::Ptr normals_in_plane(const Cloud::Ptr& points) {
  constexpr double radius = 0.3;
  pcl::search::KdTree<pcl::PointXYZ> tree;
  tree.setInputCloud(points);
  auto result = std::make_shared<Normals>();
  pcl::Indices near;
  std::vector<float> squared_distances;
  for (const pcl::PointXYZ& point : *points) {
    tree.radiusSearch(point, radius, near, squared_distances);
    Eigen::Vector2f mean = Eigen::Vector2f::Zero();
    for (const auto i : near) mean += Eigen::Vector2f((*points)[i].x, (*points)[i].y);
    mean /= static_cast<float>(near.size());
    Eigen::Matrix2f covariance = Eigen::Matrix2f::Zero();
    for (const auto i : near) {
      const Eigen::Vector2f d = Eigen::Vector2f((*points)[i].x, (*points)[i].y) - mean;
      covariance += d * d.transpose();
    }
    const Eigen::Vector2f normal =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix2f>(covariance).eigenvectors().col(0);
    result->push_back({normal.x(), normal.y(), 0.0F});
  }
  return result;
}

Features::Ptr features(const Cloud::Ptr& points) {
  constexpr double radius = 1.5;
  pcl::FPFHEstimation<pcl::PointXYZ, pcl::Normal, pcl::FPFHSignature33> estimation;
  estimation.setInputCloud(points);
  estimation.setInputNormals(normals_in_plane(points));
  estimation.setSearchMethod(std::make_shared<pcl::search::KdTree<pcl::PointXYZ>>());
  estimation.setRadiusSearch(radius);
  auto result = std::make_shared<Features>();
  estimation.compute(*result);
  return result;
}

/// RANSAM's nearest relative: triples by feature, rejected by their side lengths, verified by inliers.
/// The map's features are not timed, the local map's are. Arguments: steps, thousands of iterations.
void pcl_prerejective(benchmark::State& state) {
  const Scene& s = scene("intel");
  const Cloud::Ptr map = cloud(s.map());
  const Features::Ptr map_features = features(map);
  run_tasks(state, s, [&](const LocalMap& local) -> std::optional<Pose2> {
    const Cloud::Ptr source = cloud(local.points);
    pcl::SampleConsensusPrerejective<pcl::PointXYZ, pcl::PointXYZ, pcl::FPFHSignature33> align;
    align.setTransformationEstimation(
        std::make_shared<pcl::registration::TransformationEstimation2D<pcl::PointXYZ, pcl::PointXYZ>>());
    align.setInputSource(source);
    align.setSourceFeatures(features(source));
    align.setInputTarget(map);
    align.setTargetFeatures(map_features);
    align.setMaximumIterations(static_cast<int>(state.range(1)) * 1000);
    align.setNumberOfSamples(3);
    align.setCorrespondenceRandomness(10);
    align.setSimilarityThreshold(0.9F);
    align.setMaxCorrespondenceDistance(2.0 * epsilon);
    align.setInlierFraction(0.5F);
    Cloud moved;
    align.align(moved);
    if (!align.hasConverged()) return std::nullopt;
    return pose_of(align.getFinalTransformation()) * local.local_from_robot;
  });
}

/// ICP from places the mapping robot passed, `state.range(1)` headings in each; the result with the most
/// contact counts. The local map is thinned to every fourth point.
void pcl_icp(benchmark::State& state) {
  constexpr double between_starts_m = 2.0;
  constexpr std::size_t every = 4;
  const Scene& s = scene("intel");
  std::vector<Pose2> places;
  for (const Pose2& pose : s.prepared.map->path()) {
    const bool is_new = std::none_of(places.begin(), places.end(),
                                     [&](const Pose2& p) { return distance(p, pose) < between_starts_m; });
    if (is_new) places.push_back(pose);
  }
  const auto contact = contact_index(*s.prepared.map, "bitset", epsilon);
  pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> icp;
  icp.setInputTarget(cloud(s.map()));
  icp.setTransformationEstimation(
      std::make_shared<pcl::registration::TransformationEstimation2D<pcl::PointXYZ, pcl::PointXYZ>>());
  icp.setMaximumIterations(30);
  icp.setMaxCorrespondenceDistance(1.0);
  run_tasks(state, s, [&](const LocalMap& local) -> std::optional<Pose2> {
    Points thinned;
    for (std::size_t i = 0; i < local.points.size(); i += every) thinned.push_back(local.points[i]);
    icp.setInputSource(cloud(thinned));
    std::optional<Pose2> best;
    std::size_t most_in_contact = 0;
    for (const Pose2& place : places) {
      for (int i = 0; i < state.range(1); ++i) {
        const double heading = radians(360.0 * i / static_cast<double>(state.range(1)));
        const Pose2 start = Pose2{place.x, place.y, wrap_angle(heading)} * inverse(local.local_from_robot);
        Eigen::Matrix4f guess = Eigen::Matrix4f::Identity();
        guess.topLeftCorner<2, 2>() = Eigen::Rotation2Df(static_cast<float>(start.theta)).matrix();
        guess(0, 3) = static_cast<float>(start.x);
        guess(1, 3) = static_cast<float>(start.y);
        Cloud moved;
        icp.align(moved, guess);
        const Pose2 map_from_local = pose_of(icp.getFinalTransformation());
        const std::size_t in_contact = contact->count(thinned, 0, thinned.size(), Transform(map_from_local));
        if (in_contact <= most_in_contact) continue;
        most_in_contact = in_contact;
        best = map_from_local * local.local_from_robot;
      }
    }
    return best;
  });
}

constexpr int steps = 20;

void register_all() {
  const auto add = [](const std::string& name, auto run) {
    return benchmark::RegisterBenchmark(name.c_str(), run)->Unit(benchmark::kMillisecond);
  };
  if (!has_datasets()) return;
  add("glocal_ransam", glocal_ransam)->Arg(steps);
  add("pcl_prerejective", pcl_prerejective)->Args({steps, 50})->Args({steps, 500})->Iterations(1);
  add("pcl_icp", pcl_icp)->Args({steps, 8})->Iterations(1);
}

}  // namespace
}  // namespace glocal::bench

int main(int argc, char** argv) {
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  return glocal::bench::run_registered(argc, argv, glocal::bench::register_all);
}
