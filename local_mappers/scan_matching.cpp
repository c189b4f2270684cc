#include "local_mappers/scan_matching.hpp"

#include <algorithm>

namespace glocal::local_mappers {
namespace {

/// Standard deviation of a hit around a point of the map, in the search, m.
constexpr double likelihood_sigma = 0.1;

void describe_fit(ParamVisitor& v, double& max_free_space_violation) {
  v.field(
      "max_free_space_violation", max_free_space_violation,
      {.doc =
           "An observation fits only if the share of free-space violations stays below this: hits where the "
           "latest scans saw free space, or the other way round. More means that the robot was carried away.",
       .min = 0.0,
       .max = 1.0,
       .audience = Audience::tuner,
       .formerly = "max_seen_through"});
}

bool is_gate_in_reach(const ScanMatching::Params& p) {
  return cells_in(p.refinement.match_distance, p.voxels.resolution) <= PointGrid::max_reach;
}

}  // namespace

void describe_common(ParamVisitor& v, ScanMatching::Params& p) {
  describe(v, p.voxels);
  describe_fit(v, p.max_free_space_violation);
  v.require(is_gate_in_reach(p), "resolution",
            "must be at least 0.041 m: points are looked for in 11 cells, and 0.45 m away");
}

void describe(ParamVisitor& v, ScanMatching::Params& p) {
  describe(v, p.voxels);
  v.field("cell_hits", p.voxels.cell_hits,
          {.doc = "The point of a voxel is the mean of its first hits, so many of them.",
           .min = 1,
           .max = 100,
           .audience = Audience::expert});
  v.field("normals", p.normals, {.doc = "Normals of a scan.", .audience = Audience::expert});
  v.field("search", p.search, {.doc = "Search around odometry.", .audience = Audience::expert});
  v.field("refinement", p.refinement,
          {.doc = "Point-to-line registration after the search.", .audience = Audience::expert});
  describe_fit(v, p.max_free_space_violation);
  v.require(is_gate_in_reach(p), "refinement", "gate must be at most 11 times resolution");
}

ScanMatching::ScanMatching(const Params& params)
    : params_(params),
      map_(params.voxels,
           std::min(cells_in(params.refinement.match_distance, params.voxels.resolution),
                    PointGrid::max_reach),
           likelihood_sigma) {}

void ScanMatching::reset() {
  map_.reset();
  last_odom_from_robot_.reset();
  free_space_check_.clear();
  misfits_ = 0;
}

void ScanMatching::add(const Observation& observation) {
  insert(place(observation));
}

LocalScan ScanMatching::place(const Observation& observation) {
  const Points& hits = observation.scan.hits;
  const Points normals = scan_normals(hits, observation.scan.origin, params_.normals);
  const int misfits_before = misfits_;
  const Pose2 odom_from_robot = seen_from_above(observation.odom_from_robot);
  const Pose2 predicted = predict(odom_from_robot);
  last_odom_from_robot_ = odom_from_robot;
  map_.move_robot(match(observation.scan, normals, predicted));
  if (!map_.holds_robot() || misfits_ >= restart_after) {
    map_.start_over();
    free_space_check_.clear();
    misfits_ = 0;
  }
  if (misfits_ > misfits_before) return {};
  free_space_check_.add(observation.scan, robot());
  return {hits, normals, robot()};
}

Pose2 ScanMatching::predict(const Pose2& odom_from_robot) const {
  if (!last_odom_from_robot_) return {};
  return robot() * (inverse(*last_odom_from_robot_) * odom_from_robot);
}

Pose2 ScanMatching::match(const Scan& scan, const Points& normals, const Pose2& predicted) {
  if (map().points.empty() || scan.hits.size() < static_cast<std::size_t>(min_matches)) return predicted;
  const SearchResult found =
      correlative_search(grid(), scan.hits, predicted, params_.search, odometry_penalty);
  const bool fits = found.likelihood >= min_fit;
  const Pose2 refined = fits ? refine(scan, normals, found.local_from_robot, predicted) : predicted;
  misfits_ = fits && free_space_check_.violation(scan, refined) <= params_.max_free_space_violation
                 ? 0
                 : misfits_ + 1;
  return misfits_ > 0 ? predicted : refined;
}

Pose2 ScanMatching::refine(const Scan& scan, const Points& normals, const Pose2& found,
                           const Pose2& predicted) const {
  const ScanRegistration refined =
      register_scan(grid(), map(), scan.hits, normals, found, params_.refinement.match_distance);
  const bool sound = refined.matches >= min_matches &&
                     distance(refined.local_from_robot, found) <= max_correction &&
                     rotation_between(refined.local_from_robot, found) <= radians(max_correction_angle_deg);
  return sound ? refined.local_from_robot : predicted;
}

}  // namespace glocal::local_mappers
