#include "matchers/iransac/iransac.hpp"

#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <set>

#include "glocal/parallel.hpp"
#include "matchers/common/point_pair.hpp"

namespace glocal::iransac {
namespace {

/// Points that features are made of, one in each square of this side.
constexpr OrientedPointRule oriented_point_rule{.voxel_size = 0.1, .radius = 0.2};

/// What makes a pair of matches fit: features apart enough for a heading, and the same shape on both sides.
struct FittingPair {
  static constexpr double min_distance = 1.0;  ///< m
  static constexpr double tolerance = 0.2;     ///< m, of their distance.
  static constexpr double angle_tolerance_deg = 20.0;
  static constexpr int most = 1000;  ///< The first so many of a step become hypotheses.
};

/// Pairs of matches drawn in a step.
constexpr int draws = 20000;
/// Hypotheses left by preemption, and carried to the next step.
constexpr std::size_t most_in_pool = 100;

Point point_of(const OrientedPoints& s, std::uint32_t i) {
  return {s.x[i], s.y[i]};
}

/// One surface in each square of this side and each quarter turn of directions: as many for their length as
/// the map has, and both sides of a wall.
OrientedPoints voxel_downsampled(const OrientedPoints& oriented_points, double side) {
  std::set<std::array<int, 3>> taken;
  OrientedPoints result;
  const auto number = [](double value, double size) { return static_cast<int>(std::floor(value / size)); };
  for (std::size_t i = 0; i < oriented_points.size(); ++i) {
    const bool is_new = taken
                            .insert({number(oriented_points.x[i], side), number(oriented_points.y[i], side),
                                     number(oriented_points.angle[i], std::numbers::pi / 2.0)})
                            .second;
    if (is_new) result.add(oriented_points.x[i], oriented_points.y[i], oriented_points.angle[i]);
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

  PairShape(const OrientedPoints& s, std::uint32_t first, std::uint32_t second) {
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
          {.doc = "Features of the local map that are looked up in a step.",
           .min = 2,
           .max = 100000,
           .audience = Audience::tuner});
  v.field("matches", p.matches,
          {.doc = "Number of map features taken for each local feature: those most alike.",
           .min = 1,
           .max = 10000,
           .audience = Audience::tuner});
  v.field("lsh", p.lsh,
          {.doc = "Look features up by locality-sensitive hashing, which misses some, instead of comparing "
                  "them with all.",
           .audience = Audience::tuner});
  describe_contact_epsilon(v, p.contact_epsilon);
  v.field("best", p.best, {.doc = "Distinct poses that become hypotheses.", .min = 1, .max = 10000});
}

IRansac::IRansac(const Params& params, const StageSetup& setup)
    : params_(params),
      threads_(setup.threads),
      contact_(contact_index(*setup.map, "bitset", setup.epsilon(params.contact_epsilon))),
      refiner_(most_in_pool, PoseRefinement{}, distance_field(*setup.map, setup.threads), contact_) {
  const auto begin = std::chrono::steady_clock::now();
  index_ = setup.map->index<FeatureIndex>(params.lsh ? "hashed" : "compared", [&] {
    return FeatureIndex(oriented_points_of(*setup.map, oriented_point_rule, setup.threads),
                        ShapeContextRule{}, params.lsh ? std::optional(HashRule{}) : std::nullopt,
                        setup.threads);
  });
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
  map_index_ = {index_->oriented_points().size(), index_->memory_bytes(), took.count()};
}

MatchResult IRansac::match(const MatchRequest& request, Rng& rng) {
  const LocalMap& local = request.local;
  if (local.epoch != epoch_) pool_.clear();
  epoch_ = local.epoch;
  MatchResult result;
  if (local.points.empty()) return result;

  const std::size_t carried = pool_.size();
  propose(local, rng);
  result.proposals = pool_.size() - carried;
  const Points shuffled = sample_of(local.points, local.points.size(), rng);
  const Points latest = latest_points(local);
  result.points_tested = preempt(pool_, *contact_, shuffled, sample_of(latest, latest.size(), rng),
                                 {.fewest = most_in_pool}, threads_);

  std::vector<Candidate> candidates;
  for (const ScoredPose& pose : pool_) candidates.push_back({pose.map_from_local, pose.score()});
  candidates = refiner_.refined(std::move(candidates), seen_from_above(local.local_from_robot), shuffled,
                                local.points);
  result.points_tested += candidates.size() * local.points.size();
  pool_.clear();
  for (const Candidate& candidate : candidates) {
    const auto n = static_cast<double>(local.points.size());
    pool_.push_back({candidate.map_from_local, static_cast<std::size_t>(std::lround(candidate.quality * n)),
                     local.points.size()});
    if (candidate.quality < request.omega_max ||
        result.hypotheses.size() == static_cast<std::size_t>(params_.best))
      continue;
    result.hypotheses.push_back(Hypothesis::by_contact(candidate.map_from_local, candidate.quality));
  }
  return result;
}

/// Adds fresh hypotheses to the pool.
void IRansac::propose(const LocalMap& local, Rng& rng) {
  const OrientedPoints oriented_points =
      voxel_downsampled(oriented_points_of(local, oriented_point_rule), oriented_point_rule.voxel_size);
  const std::vector<std::uint32_t> drawn =
      draw_numbers(static_cast<std::size_t>(params_.features), oriented_points.size(), rng);
  if (drawn.size() < 2) return;
  const FeatureVectors features = shape_contexts(oriented_points, drawn, ShapeContextRule{}, threads_);
  std::vector<std::vector<std::uint32_t>> matches(drawn.size());
  parallel_for(threads_, drawn.size(), [&](std::size_t i) {
    matches[i] = index_->nearest(features[i], static_cast<std::size_t>(params_.matches));
  });

  const auto any = [&](std::size_t n) { return rng.below(static_cast<std::uint32_t>(n)); };
  const OrientedPoints& map = index_->oriented_points();
  const double angle = radians(FittingPair::angle_tolerance_deg);
  MotionBatch motion;
  int proposed = 0;
  for (int draw = 0; draw < draws && proposed < FittingPair::most; ++draw) {
    const std::size_t first = any(drawn.size());
    const std::size_t second = any(drawn.size());
    if (matches[first].empty() || matches[second].empty()) continue;
    const std::uint32_t map_first = matches[first][any(matches[first].size())];
    const std::uint32_t map_second = matches[second][any(matches[second].size())];
    const PairShape pair(oriented_points, drawn[first], drawn[second]);
    if (pair.length < FittingPair::min_distance) continue;
    if (!pair.is_like(PairShape(map, map_first, map_second), FittingPair::tolerance, angle)) continue;
    lay({point_of(oriented_points, drawn[first]), point_of(oriented_points, drawn[second])},
        {point_of(map, map_first), point_of(map, map_second)}, motion, 0);
    pool_.push_back({motion[0].pose()});
    ++proposed;
  }
}

}  // namespace glocal::iransac
