#include "local_mappers/scan_matching.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace glocal {

namespace {

constexpr double bytes_per_mb = 1e6;

std::size_t tiles_in(int memory_mb) {
  return static_cast<std::size_t>(memory_mb * bytes_per_mb / static_cast<double>(PointGrid::tile_bytes()));
}

int cells_in(double metres, double resolution) {
  return static_cast<int>(std::ceil(metres / resolution));
}

/// The normal of `n` hits whose mean normal is `mean`, and one more. A normal from the other side of a thin
/// wall is left out.
Point average_normal(const Point& mean, float n, const Point& normal) {
  const float cosine = mean.x * normal.x + mean.y * normal.y;
  if (cosine < 0.0F) return mean;
  const float x = mean.x * n + normal.x;
  const float y = mean.y * n + normal.y;
  const float length = std::sqrt(x * x + y * y);
  if (length <= 0.0F) return {};
  return {x / length, y / length, 0.0F};
}

}  // namespace

void describe(ParamVisitor& v, ScanMatching::Params& p) {
  v.field("resolution", p.resolution,
          {.doc = "Side of the cells that thin the map, and of those that index it.",
           .unit = "m",
           .max = 1.0,
           .above = 0.001});
  v.field("cell_hits", p.cell_hits,
          {.doc = "A cell's point is the mean of so many of its first hits.", .min = 1, .max = 100});
  v.field("likelihood_sigma", p.likelihood_sigma,
          {.doc = "Standard deviation of a hit around a point of the map, in the search.",
           .unit = "m",
           .above = 0.0});
  v.field("normals", p.normals, {.doc = "Normals of a scan."});
  v.field("search", p.search, {.doc = "Search around odometry."});
  v.field("wide_search", p.wide_search,
          {.doc = "Search in place of the first where that finds nothing that fits well: wheels slip, logs "
                  "have jumps."});
  v.field(
      "wide_search_below", p.wide_search_below,
      {.doc =
           "Mean likelihood of the first search below which the wide one is tried; its result must reach it.",
       .min = 0.0,
       .max = 1.0});
  v.field("wide_search_gain", p.wide_search_gain,
          {.doc = "By how much more likely than the first search's its result must be to be taken.",
           .min = 0.0,
           .max = 1.0});
  v.field("refinement", p.refinement, {.doc = "Point-to-line registration after the search."});
  v.field("min_matches", p.min_matches,
          {.doc = "With fewer matched hits odometry is kept.", .min = 3, .max = 100000});
  v.field("max_correction", p.max_correction,
          {.doc = "If refinement moves farther from where the search ended, odometry is kept.",
           .unit = "m",
           .min = 0.0});
  v.field("max_correction_angle", p.max_correction_angle,
          {.doc = "If refinement moves farther from where the search ended, odometry is kept.",
           .unit = "rad",
           .min = 0.0});
  v.field("min_fit", p.min_fit,
          {.doc = "An observation whose mean likelihood stays below this after the search does not fit; it "
                  "moves the "
                  "robot by odometry and adds no points.",
           .min = 0.0,
           .max = 1.0});
  v.field("max_seen_through", p.max_seen_through,
          {.doc = "Nor does one fit of which more lies where the latest scans saw through, or which saw "
                  "through more "
                  "of what they met: the robot was carried away.",
           .min = 0.0,
           .max = 1.0});
  v.field("sight", p.sight, {.doc = "How scans are compared for that."});
  v.field(
      "restart_after", p.restart_after,
      {.doc =
           "Observations in a row that do not fit before a new local map is started with the last of them.",
       .min = 1});
  v.field("memory_mb", p.memory_mb,
          {.doc = "Memory the index of the points may take.", .unit = "MB", .min = 1, .max = 65536});
  v.require(cells_in(p.refinement.gate, p.resolution) <= PointGrid::max_reach, "refinement",
            "gate must be at most 11 times resolution");
}

ScanMatching::ScanMatching(const Params& params)
    : params_(params),
      grid_(params.resolution,
            std::min(cells_in(params.refinement.gate, params.resolution), PointGrid::max_reach),
            params.likelihood_sigma, tiles_in(params.memory_mb)),
      sights_(params.sight) {}

void ScanMatching::reset() {
  start_over();
  map_.generation = 0;
  last_odom_from_robot_.reset();
}

void ScanMatching::start_over() {
  map_ = {.points = {}, .normals = {}, .local_from_robot = {}, .ends = {}, .generation = map_.generation + 1};
  hits_.clear();
  next_above_.clear();
  grid_.clear();
  sights_.clear();
  misfits_ = 0;
}

void ScanMatching::add(const Observation& observation) {
  const Points& hits = observation.scan.hits;
  const Points normals = scan_normals(hits, observation.scan.origin, params_.normals);
  const int misfits_before = misfits_;
  const Pose2 predicted = predict(observation.odom_from_robot);
  last_odom_from_robot_ = observation.odom_from_robot;
  map_.local_from_robot = match(observation.scan, normals, predicted);
  const Pose2& pose = map_.local_from_robot;
  const bool outside = !grid_.contains(static_cast<float>(pose.x), static_cast<float>(pose.y));
  if (outside || misfits_ >= params_.restart_after) start_over();
  if (misfits_ <= misfits_before) {
    register_hits(hits, normals);
    sights_.add(observation.scan, map_.local_from_robot);
  }
  map_.ends.push_back(map_.points.size());
}

Pose2 ScanMatching::predict(const Pose2& odom_from_robot) const {
  if (!last_odom_from_robot_) return {};
  return map_.local_from_robot * (inverse(*last_odom_from_robot_) * odom_from_robot);
}

Pose2 ScanMatching::match(const Scan& scan, const Points& normals, const Pose2& predicted) {
  if (map_.points.empty() || scan.hits.size() < static_cast<std::size_t>(params_.min_matches))
    return predicted;
  const SearchResult found = search(scan.hits, predicted);
  const bool fits = found.likelihood >= params_.min_fit;
  const Pose2 refined = fits ? refine(scan, normals, found.local_from_robot, predicted) : predicted;
  misfits_ = fits && sights_.seen_through(scan, refined) <= params_.max_seen_through ? 0 : misfits_ + 1;
  return misfits_ > 0 ? predicted : refined;
}

Pose2 ScanMatching::refine(const Scan& scan, const Points& normals, const Pose2& found,
                           const Pose2& predicted) const {
  const Registration refined = register_scan(grid_, map_, scan.hits, normals, found, params_.refinement);
  const bool sound = refined.matches >= params_.min_matches &&
                     distance(refined.local_from_robot, found) <= params_.max_correction &&
                     rotation_between(refined.local_from_robot, found) <= params_.max_correction_angle;
  return sound ? refined.local_from_robot : predicted;
}

SearchResult ScanMatching::search(const Points& hits, const Pose2& predicted) const {
  const SearchResult near = correlative_search(grid_, hits, predicted, params_.search);
  if (near.likelihood >= params_.wide_search_below) return near;
  const SearchResult far = correlative_search(grid_, hits, predicted, params_.wide_search);
  // Far from odometry only a good fit is believed: every place resembles some other a little.
  const double needed = std::max(params_.wide_search_below, near.likelihood + params_.wide_search_gain);
  return far.likelihood >= needed ? far : near;
}

void ScanMatching::register_hits(const Points& hits, const Points& normals) {
  const Transform local_from_robot(map_.local_from_robot);
  const Transform rotation({0.0, 0.0, map_.local_from_robot.theta});
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const Point p = local_from_robot(hits[i]);
    if (grid_.contains(p.x, p.y)) register_hit(p, rotation(normals[i]));
  }
}

void ScanMatching::register_hit(const Point& p, const Point& normal) {
  const GridCell cell = grid_.cell(p.x, p.y);
  const int found = find_point(cell, p.z);
  if (found != PointGrid::none) {
    average_into(static_cast<std::size_t>(found), p, normal);
  } else {
    append_point(cell, p, normal);
  }
}

int ScanMatching::find_point(GridCell cell, float z) const {
  const auto layer = [this](float height) {
    return std::floor(height / static_cast<float>(params_.resolution));
  };
  int i = grid_.inside(cell);
  while (i != PointGrid::none && layer(map_.points.z[static_cast<std::size_t>(i)]) != layer(z)) {
    i = next_above_[static_cast<std::size_t>(i)];
  }
  return i;
}

void ScanMatching::append_point(GridCell cell, const Point& p, const Point& normal) {
  const std::size_t index = map_.points.size();
  if (index >= PointGrid::max_points) return;
  const int first = grid_.inside(cell);
  std::int32_t next = PointGrid::none;
  if (first != PointGrid::none) {
    // The column's first point stays the one that scans are matched to; others are chained behind it.
    next = std::exchange(next_above_[static_cast<std::size_t>(first)], static_cast<std::int32_t>(index));
  } else if (!grid_.insert(cell, index)) {
    return;
  }
  map_.points.push_back(p);
  map_.normals.push_back(normal);
  hits_.push_back(1);
  next_above_.push_back(next);
}

void ScanMatching::average_into(std::size_t index, const Point& p, const Point& normal) {
  if (hits_[index] >= params_.cell_hits) return;
  const auto n = static_cast<float>(hits_[index]++);
  const Point mean = map_.points[index];
  const auto average = [n](float a, float b) { return a + (b - a) / (n + 1.0F); };
  map_.points.set(index, {average(mean.x, p.x), average(mean.y, p.y), average(mean.z, p.z)});
  map_.normals.set(index, average_normal(map_.normals[index], n, normal));
}

}  // namespace glocal
