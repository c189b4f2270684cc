#include "matchers/surfel_ransam/surfel_ransam.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "glocal/cloud_resolution.hpp"
#include "glocal/error.hpp"
#include "glocal/evenly.hpp"

namespace glocal::surfel_ransam {
namespace {

/// Rounds of a step at most, when nothing is carried on yet: the last one is that which finds the best pose
/// once more, if no other comes near.
constexpr std::size_t first_rounds = 24;
/// Pairs of surfels drawn from the local map in each round.
constexpr std::size_t draws = 600;
/// Pairs of the map that are tried for each drawn pair.
constexpr std::size_t partners = 8;
/// What the share of the map's surfels that the latest scan looked through, among those it looked at, takes
/// from the score.
constexpr double seen_through_weight = 1.0;

/// The local map's surfels, finer than those of the map: a narrow view has few. With the view of the latest
/// scan: where a local map of many scans was seen from is not known.
surfels::PreparedCloud prepared(const LocalMap& local, const Scan& latest, float voxel_size) {
  const float side = 2.0F / 3.0F * voxel_size;
  surfels::PreparedCloud cloud(surfels::points_in_view(local, side), side, std::nullopt);
  if (!latest.hits.empty()) {
    const RigidMotion local_from_robot(local.local_from_robot);
    cloud.view.emplace(moved(latest.hits, local.local_from_robot), local_from_robot(latest.origin));
  }
  return cloud;
}

/// A surfel is tested in the time of so many looks at a point: it is moved with its normal, and lies on one
/// of several planes (120 to 140 ns in a building, at 8 to 10 ns for a look of a search of the whole map).
constexpr std::size_t looks_of_surfel = 12;

/// Points that are enough for the share in contact.
constexpr std::size_t most_sampled = 2000;

SurfelIndexRule index_rule(const SurfelRansam::Params& params, const GlobalMap& map) {
  return {.voxel_size = static_cast<float>(params.voxel_size.value_or(map_voxel_size(map.resolution()))),
          .pairs = static_cast<std::size_t>(params.pairs)};
}

}  // namespace

void describe(ParamVisitor& v, SurfelRansam::Params& p) {
  describe_contact_epsilon(v, p.contact_epsilon);
  v.field("voxel_size", p.voxel_size,
          {.doc = "Side of the voxels of map and local map that give one surfel each; auto takes three times "
                  "the map's resolution, and at least 0.1 m.",
           .unit = "m",
           .min = 0.01,
           .max = 100.0,
           .audience = Audience::tuner});
  v.field("best", p.best,
          {.doc = "Number of poses that become hypotheses: those with the highest scores.",
           .min = 1,
           .max = 10000,
           .audience = Audience::expert});
  v.field("carried", p.carried,
          {.doc = "Number of hypotheses carried on to the next step: those with the highest scores.",
           .min = 0,
           .max = 10000,
           .audience = Audience::expert});
  v.field("pairs", p.pairs,
          {.doc = "Pairs of surfels in the index of the map (8 bytes each).",
           .min = 1000,
           .max = 100e6,
           .audience = Audience::expert});
  v.field("rounds", p.rounds,
          {.doc = "Rounds of any other step at most.", .min = 0, .max = 1000, .audience = Audience::tuner});
  v.field("free_space_weight", p.free_space_weight,
          {.doc = "What the share of points that lie where the map is known to be free takes from the score; "
                  "of no effect on maps that know of no free space in three dimensions.",
           .min = 0.0,
           .max = 100.0,
           .audience = Audience::tuner});
}

SurfelRansam::SurfelRansam(const Params& params, const StageSetup& setup)
    : params_(params),
      upright_(setup.motion == Motion::upright),
      map_(setup.map),
      rule_(index_rule(params, *setup.map)),
      contact_(contact_index(*setup.map, "bitset", setup.epsilon(params.contact_epsilon))),
      index_(surfel_index(*setup.map, rule_)),
      looks_per_step_(setup.looks_per_step) {
  if (index_->pairs.size() == 0) {
    throw ConfigError(
        "", fmt::format("the map has no surfaces to be found by voxels of {:.2f} m: surfel_ransam needs them",
                        rule_.voxel_size));
  }
}

std::optional<MapIndexInfo> SurfelRansam::map_index() const {
  return MapIndexInfo{index_->pairs.size(), index_->memory_bytes(), index_->build_ms};
}

double SurfelRansam::free_space_violation(const Points& points, const Pose3& map_from_points) const {
  const FreeVoxels& free = map_->free_voxels();
  if (free.empty()) return 0.0;
  const Points in_map = moved(points, map_from_points);
  std::size_t violating = 0;
  for (std::size_t i = 0; i < in_map.size(); ++i) {
    if (free.contains(in_map[i]) && contact_->count(in_map, i, 1, Transform(Pose2{})) == 0) ++violating;
  }
  return static_cast<double>(violating) / static_cast<double>(points.size());
}

surfels::PoseSearch SurfelRansam::search_of(const LocalMap& local, const PoseGate& gate, std::size_t rounds,
                                            std::span<const RigidMotion> known, const Rng& rng) const {
  surfels::PointJudge judge_sample =
      [this, sample = evenly_chosen(local.points, most_sampled)](const RigidMotion& motion) {
        const Pose3 pose = motion.pose();
        return surfels::PointEvidence{contact_->share(sample, pose), free_space_violation(sample, pose),
                                      sample.size()};
      };
  const surfels::PoseSearchParams params{.rounds = rounds,
                                         .draws = draws,
                                         .partners = partners,
                                         .seen_through_weight = seen_through_weight,
                                         .free_space_weight = params_.free_space_weight,
                                         .upright = upright_,
                                         .gate = gate};
  return {index_->map, index_->pairs, index_->pair_rule,      *prepared_, params,
          rng,         known,         std::move(judge_sample)};
}

Hypothesis SurfelRansam::to_hypothesis(const surfels::FoundPose& pose, const LocalMap& local) const {
  Hypothesis h;
  h.map_from_local = pose.target_from_source.pose();
  h.quality = contact_->share(local.points, h.map_from_local);
  h.score = pose.score;
  if (!map_->free_voxels().empty()) h.free_space_violation = pose.in_free_space;
  return h;
}

void SurfelRansam::reset() {
  open_.reset();
  carried_.clear();
}

/// Those that the step before has left, too, if the next scan came before its search was over.
std::size_t SurfelRansam::rounds_of_step() const {
  if (carried_.empty()) return first_rounds;
  const auto rounds = static_cast<std::size_t>(params_.rounds);
  return open_ && !open_->search.is_over() ? std::max(rounds, open_->search.rounds_left()) : rounds;
}

MatchResult SurfelRansam::match(const MatchRequest& request, Rng& rng) {
  const LocalMap& local = request.local;
  if (local.points.empty()) return {};
  if (local.epoch != epoch_) reset();
  epoch_ = local.epoch;
  const std::size_t rounds = rounds_of_step();
  open_.reset();
  prepared_.emplace(prepared(local, request.latest.scan, rule_.voxel_size));
  open_.emplace(OpenStep{search_of(local, request.gate, rounds, carried_, rng), request.omega_max});
  return go_on(local, looks_per_step_);
}

MatchResult SurfelRansam::go_on(const LocalMap& local, std::size_t looks) {
  open_->search.advance(std::max<std::size_t>(1, looks / looks_of_surfel));
  auto [found, effort] = open_->search.result();
  found.resize(std::min(found.size(), static_cast<std::size_t>(params_.best)));
  MatchResult result{.hypotheses = {},
                     .proposals = effort.proposals,
                     .points_tested = effort.points_tested,
                     .goes_on = !open_->search.is_over()};
  carried_.clear();
  for (const surfels::FoundPose& pose : found) {
    if (carried_.size() < static_cast<std::size_t>(params_.carried))
      carried_.push_back(pose.target_from_source);
    if (pose.score < open_->omega_max) continue;
    result.hypotheses.push_back(to_hypothesis(pose, local));
    result.points_tested += local.points.size();
  }
  return result;
}

/// Refines them, too: contact alone leaves them a little beside the surfaces that they fit.
std::vector<Hypothesis> SurfelRansam::rescore(std::vector<Hypothesis> found, const LocalMap& local) {
  std::vector<RigidMotion> known;
  for (const Hypothesis& h : found) known.emplace_back(h.map_from_local);
  const surfels::PoseSearch search = search_of(local, {}, 0, known, Rng(local.points.size()));
  found.clear();
  for (const surfels::FoundPose& pose : search.result().poses) {
    carried_.push_back(pose.target_from_source);
    Hypothesis& h = found.emplace_back(to_hypothesis(pose, local));
    h.score = std::max(h.score, 0.0);
  }
  return found;
}

}  // namespace glocal::surfel_ransam
