#include "icp.hpp"

#include <pcl/registration/icp.h>
#include <pcl/registration/transformation_estimation_2D.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "glocal/error.hpp"
#include "glocal/parallel.hpp"

namespace glocal::pcl_plugin {
namespace {

/// Starts handled by one thread together. Fixed, so that the answer does not depend on the number of threads.
constexpr std::size_t starts_per_chunk = 32;

/// Free places of the map in rows and columns so far apart, each in several headings.
std::vector<Pose2> starts_on(const OccupancyGrid& grid, double spacing, int headings) {
  const int step = std::max(1, static_cast<int>(std::lround(spacing / grid.resolution)));
  std::vector<Pose2> starts;
  for (int row = step / 2; row < grid.height; row += step) {
    for (int column = step / 2; column < grid.width; column += step) {
      if (grid.cell(column, row) != Cell::free) continue;
      const Pose2 place = grid.centre(column, row);
      for (int i = 0; i < headings; ++i) {
        starts.push_back({place.x, place.y, wrap_angle(2.0 * std::numbers::pi * i / headings)});
      }
    }
  }
  return starts;
}

}  // namespace

void describe(ParamVisitor& v, IcpParams& p) {
  v.field("points", p.points, {.doc = "Points of the local map used, at most.", .min = 10});
  v.field("iterations", p.iterations, {.doc = "Iterations at most.", .min = 1});
  v.field("max_distance", p.max_distance,
          {.doc = "Points farther apart do not correspond.", .unit = "m", .above = 0.0});
}

void describe(ParamVisitor& v, PclIcp::Params& p) {
  v.field("start_spacing", p.start_spacing,
          {.doc = "Distance between places to start from.", .unit = "m", .above = 0.0});
  v.field("start_headings", p.start_headings,
          {.doc = "Headings to start with in each place.", .min = 1, .max = 360});
  v.field("coarse", p.coarse, {.doc = "ICP from every start."});
  v.field("keep", p.keep,
          {.doc = "Poses that go on to the fine level: those with the most contact.", .min = 1});
  v.field("fine", p.fine, {.doc = "ICP from what the coarse level found."});
  describe_contact_epsilon(v, p.contact_epsilon);
}

IcpAligner::IcpAligner(const Points& map_points) : map_(cloud(map_points)), tree_(std::make_shared<Tree>()) {
  tree_->setInputCloud(map_);
}

std::vector<Pose2> IcpAligner::align(const Points& points, const std::vector<Pose2>& starts,
                                     const IcpParams& params, int threads) const {
  using Estimation = pcl::registration::TransformationEstimation2D<pcl::PointXYZ, pcl::PointXYZ>;
  const Cloud::Ptr source = cloud(points, static_cast<std::size_t>(params.points));
  std::vector<Pose2> reached(starts.size());
  parallel_for(threads, (starts.size() + starts_per_chunk - 1) / starts_per_chunk, [&](std::size_t chunk) {
    pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> icp;
    icp.setTransformationEstimation(std::make_shared<Estimation>());
    icp.setMaximumIterations(params.iterations);
    icp.setMaxCorrespondenceDistance(params.max_distance);
    icp.setSearchMethodTarget(tree_, true);
    icp.setInputTarget(map_);
    icp.setInputSource(source);
    Cloud moved;
    const std::size_t end = std::min((chunk + 1) * starts_per_chunk, starts.size());
    for (std::size_t i = chunk * starts_per_chunk; i < end; ++i) {
      icp.align(moved, matrix(starts[i]));
      reached[i] = pose(icp.getFinalTransformation());
    }
  });
  return reached;
}

std::vector<Hypothesis> rated(const std::vector<Pose2>& poses, const LocalMap& local,
                              const ContactIndex& contact, double omega_max) {
  std::vector<Hypothesis> hypotheses;
  for (const Pose2& pose : poses) {
    const double omega = contact.share(local.points, Transform(pose));
    if (omega >= omega_max) hypotheses.push_back(Hypothesis::by_contact(pose, omega));
  }
  std::stable_sort(hypotheses.begin(), hypotheses.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.score > b.score; });
  return hypotheses;
}

PclIcp::PclIcp(const Params& params, const StageSetup& setup)
    : params_(params),
      threads_(setup.threads),
      map_from_robot_starts_(starts_on(setup.map->grid(), params.start_spacing, params.start_headings)),
      contact_(contact_index(*setup.map, "bitset", setup.epsilon(params.contact_epsilon))),
      aligner_(setup.map->points()) {
  if (!map_from_robot_starts_.empty()) return;
  throw ConfigError(
      "",
      "localizer.matcher.pcl_icp: start_spacing: the map has no free cell to start from; take a "
      "smaller spacing, or a map with free space");
}

MatchResult PclIcp::match(const MatchRequest& request, Rng& /*rng*/) {
  const LocalMap& local = request.local;
  if (local.points.empty()) return {};
  const Pose2 robot_from_local = inverse(seen_from_above(local.local_from_robot));
  std::vector<Pose2> starts;
  for (const Pose2& map_from_robot : map_from_robot_starts_)
    starts.push_back(map_from_robot * robot_from_local);

  std::vector<Hypothesis> coarse =
      rated(aligner_.align(local.points, starts, params_.coarse, threads_), local, *contact_, 0.0);
  coarse.resize(std::min(coarse.size(), static_cast<std::size_t>(params_.keep)));
  std::vector<Pose2> promising;
  for (const Hypothesis& h : coarse) promising.push_back(seen_from_above(h.map_from_local));

  MatchResult result;
  result.hypotheses = rated(aligner_.align(local.points, promising, params_.fine, threads_), local, *contact_,
                            request.omega_max);
  result.proposals = starts.size();
  result.points_tested = (starts.size() + promising.size()) * local.points.size();
  return result;
}

}  // namespace glocal::pcl_plugin
