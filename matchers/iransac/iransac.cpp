#include "matchers/iransac/iransac.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <set>

#include "glocal/parallel.hpp"
#include "matchers/common/point_pair.hpp"

namespace glocal {
namespace {

SurfaceRule surface_rule(const IRansac::Params& p) {
  return {.thinning = p.thinning, .radius = p.normal_radius};
}

std::string index_key(const IRansac::Params& p) {
  const ShapeContextRule& s = p.shape_context;
  const std::string hashing =
      p.lsh ? fmt::format("{} {} {}", p.hashing.tables, p.hashing.projections, p.hashing.bucket_width) : "";
  return fmt::format("{} {} {} {} {} {} {}", p.thinning, p.normal_radius, s.radius, s.nearest, s.rings,
                     s.sectors, hashing);
}

Point point_of(const Surfaces& s, std::uint32_t i) {
  return {s.x[i], s.y[i]};
}

/// One surface in each square of this side and each quarter turn of directions: as many for their length as
/// the map has, and both sides of a wall.
Surfaces thinned(const Surfaces& surfaces, double side) {
  std::set<std::array<int, 3>> taken;
  Surfaces result;
  const auto number = [](double value, double size) { return static_cast<int>(std::floor(value / size)); };
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const bool is_new = taken
                            .insert({number(surfaces.x[i], side), number(surfaces.y[i], side),
                                     number(surfaces.angle[i], std::numbers::pi / 2.0)})
                            .second;
    if (is_new) result.add(surfaces.x[i], surfaces.y[i], surfaces.angle[i]);
  }
  return result;
}

/// The points of the last observation.
Points latest_points(const LocalMap& local) {
  Points points;
  const std::size_t begin = local.ends.size() < 2 ? 0 : local.ends[local.ends.size() - 2];
  for (std::size_t i = begin; i < local.points.size(); ++i) points.push_back(local.points[i]);
  return points;
}

/// Two oriented points: their distance, and the angles of their normals with the line between them.
struct PairShape {
  double length;
  double first_angle;
  double second_angle;

  PairShape(const Surfaces& s, std::uint32_t first, std::uint32_t second) {
    const double dx = s.x[second] - s.x[first];
    const double dy = s.y[second] - s.y[first];
    const double direction = std::atan2(dy, dx);
    length = std::hypot(dx, dy);
    first_angle = s.angle[first] - direction;
    second_angle = s.angle[second] - direction;
  }
  [[nodiscard]] bool is_like(const PairShape& other, double distance, double angle) const {
    return std::abs(length - other.length) <= distance &&
           std::abs(wrap_angle(first_angle - other.first_angle)) <= angle &&
           std::abs(wrap_angle(second_angle - other.second_angle)) <= angle;
  }
};

}  // namespace

void describe(ParamVisitor& v, IRansac::Params& p) {
  v.field("features", p.features,
          {.doc = "Features of the local map that are looked up in a step.", .min = 2, .max = 100000});
  v.field("matches", p.matches,
          {.doc = "Map features taken for each: those most alike.", .min = 1, .max = 10000});
  v.field("lsh", p.lsh,
          {.doc = "Look features up by locality-sensitive hashing, which misses some, instead of comparing "
                  "them with all."});
  v.field("hashing", p.hashing, {.doc = "How they are hashed."});
  v.field("shape_context", p.shape_context, {.doc = "What makes a feature."});
  v.field("thinning", p.thinning,
          {.doc = "Features and what makes them: one point in each square of this side.",
           .unit = "m",
           .min = 0.01});
  v.field("normal_radius", p.normal_radius,
          {.doc = "Neighbours that give a point's normal.", .unit = "m", .above = 0.0});
  v.field("draws", p.draws, {.doc = "Pairs of matches drawn in a step.", .min = 0, .max = 100e6});
  v.field("fresh", p.fresh,
          {.doc = "Of these, the first so many that fit become hypotheses.", .min = 0, .max = 1e6});
  v.field("min_distance", p.min_distance,
          {.doc = "Features nearer to each other give poor headings and are no pair.",
           .unit = "m",
           .above = 0.0});
  v.field(
      "tolerance", p.tolerance,
      {.doc = "By how much the distances of a pair on both sides may differ.", .unit = "m", .above = 0.0});
  v.field("angle_tolerance_deg", p.angle_tolerance_deg,
          {.doc = "By how much its normals may.", .unit = "deg", .max = 180.0, .above = 0.0});
  v.field("block", p.block,
          {.doc = "Observations after which half of the hypotheses are given up (B of Nister 2003).",
           .min = 1,
           .max = 100000});
  v.field("pool", p.pool,
          {.doc = "Hypotheses left by preemption, and carried to the next step.", .min = 1, .max = 100000});
  v.field("contact_epsilon", p.contact_epsilon,
          {.doc = "Distance at which a point is in contact with the map (epsilon of eq. 4).",
           .unit = "m",
           .above = 0.0});
  v.field("best", p.best, {.doc = "Distinct poses that become hypotheses.", .min = 1, .max = 10000});
  describe(v, p.mode);
  v.field("refinement", p.refinement, {.doc = "How poses are refined on the distance field."});
  v.field("field_cell", p.field_cell,
          {.doc = "Side of a cell of the distance field.", .unit = "m", .min = 0.01, .max = 1.0});
}

IRansac::IRansac(const Params& params, const StageSetup& setup)
    : params_(params),
      threads_(setup.threads),
      contact_(contact_index(*setup.map, "bitset", params.contact_epsilon)),
      refiner_(params.mode, static_cast<std::size_t>(params.pool), params.refinement,
               distance_field(*setup.map, params.field_cell), contact_) {
  const auto begin = std::chrono::steady_clock::now();
  index_ = setup.map->index<FeatureIndex>(index_key(params), [&] {
    return FeatureIndex(surfaces_of(*setup.map, surface_rule(params)), params.shape_context,
                        params.lsh ? std::optional(params.hashing) : std::nullopt, setup.threads);
  });
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
  map_index_ = {index_->surfaces().size(), index_->memory_bytes(), took.count()};
}

MatchResult IRansac::match(const LocalMap& local, const Observation& /*latest*/, double omega_max, Rng& rng) {
  if (local.generation != generation_) pool_.clear();
  generation_ = local.generation;
  MatchResult result;
  if (local.points.empty()) return result;

  const std::size_t carried = pool_.size();
  propose(local, rng);
  result.collisions = pool_.size() - carried;
  const Points shuffled = sample_of(local.points, local.points.size(), rng);
  const Points latest = latest_points(local);
  result.checks =
      preempt(pool_, *contact_, shuffled, sample_of(latest, latest.size(), rng),
              {static_cast<std::size_t>(params_.block), static_cast<std::size_t>(params_.pool)}, threads_);

  std::vector<Mode> modes;
  for (const ScoredPose& pose : pool_) modes.push_back({pose.map_from_local, pose.score()});
  modes = refiner_.refined(std::move(modes), local.local_from_robot, shuffled, local.points);
  result.checks += modes.size() * local.points.size();
  pool_.clear();
  for (const Mode& mode : modes) {
    const auto n = static_cast<double>(local.points.size());
    pool_.push_back(
        {mode.map_from_local, static_cast<std::size_t>(std::lround(mode.quality * n)), local.points.size()});
    if (mode.quality < omega_max || result.hypotheses.size() == static_cast<std::size_t>(params_.best))
      continue;
    result.hypotheses.push_back(
        {mode.map_from_local, mode.map_from_local * local.local_from_robot, mode.quality});
  }
  return result;
}

/// Adds fresh hypotheses to the pool.
void IRansac::propose(const LocalMap& local, Rng& rng) {
  const Surfaces surfaces = thinned(surfaces_of(local, surface_rule(params_)), params_.thinning);
  const std::vector<std::uint32_t> drawn =
      draw_numbers(static_cast<std::size_t>(params_.features), surfaces.size(), rng);
  if (drawn.size() < 2) return;
  const FeatureVectors features = shape_contexts(surfaces, drawn, params_.shape_context, threads_);
  std::vector<std::vector<std::uint32_t>> matches(drawn.size());
  parallel_for(threads_, drawn.size(), [&](std::size_t i) {
    matches[i] = index_->nearest(features[i], static_cast<std::size_t>(params_.matches));
  });

  const auto any = [&](std::size_t n) { return rng.below(static_cast<std::uint32_t>(n)); };
  const Surfaces& map = index_->surfaces();
  const double angle = radians(params_.angle_tolerance_deg);
  MotionBatch motion;
  int proposed = 0;
  for (int draw = 0; draw < params_.draws && proposed < params_.fresh; ++draw) {
    const std::size_t first = any(drawn.size());
    const std::size_t second = any(drawn.size());
    if (matches[first].empty() || matches[second].empty()) continue;
    const std::uint32_t map_first = matches[first][any(matches[first].size())];
    const std::uint32_t map_second = matches[second][any(matches[second].size())];
    const PairShape pair(surfaces, drawn[first], drawn[second]);
    if (pair.length < params_.min_distance) continue;
    if (!pair.is_like(PairShape(map, map_first, map_second), params_.tolerance, angle)) continue;
    lay({point_of(surfaces, drawn[first]), point_of(surfaces, drawn[second])},
        {point_of(map, map_first), point_of(map, map_second)}, motion, 0);
    pool_.push_back({motion[0].pose()});
    ++proposed;
  }
}

}  // namespace glocal
