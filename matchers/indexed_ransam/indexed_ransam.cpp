#include "matchers/indexed_ransam/indexed_ransam.hpp"

#include <algorithm>
#include <chrono>

#include "matchers/indexed_ransam/proposals.hpp"

namespace glocal::indexed_ransam {
namespace {

/// Squares of the map that give one oriented point each; its normal is of what is within twice as much.
constexpr double voxel_size = 0.1;

RelationRule relation_rule(const IndexedRansam::Params& p) {
  return {.relation = p.relation,
          .points = {.voxel_size = voxel_size, .radius = 2.0 * voxel_size},
          .pairs = {.min_length = p.min_length}};
}

JudgeRule judge_rule(const IndexedRansam::Params& p, double contact_epsilon) {
  return {.beams = p.beams,
          .unknown_weight = p.unknown_weight,
          .most = static_cast<std::size_t>(p.best),
          .contact_epsilon = contact_epsilon,
          .kernel = p.refinement.kernel};
}

/// Steps in which there are first_iterations: from then on the best poses of the steps before are there.
constexpr int first_steps = 4;

/// Points of the local map that judge a proposal's contact before it is refined.
constexpr std::size_t contact_points = 128;
constexpr std::size_t proposals_per_candidate = 5;  // As many lie near each other.

}  // namespace

void describe(ParamVisitor& v, IndexedRansam::Params& p) {
  v.field(
      "iterations", p.iterations,
      {.doc = "Poses proposed in a step, by oriented point pairs or triangles drawn from the local map; on a "
              "map of more than 80,000 oriented points as many more as it has more of them, up to 24,000.",
       .min = 0,
       .max = 10e6,
       .audience = Audience::tuner});
  v.field("first_iterations", p.first_iterations,
          {.doc = "Poses proposed in each of the first four steps at least, when nothing is carried on yet.",
           .min = 0,
           .max = 10e6});
  v.removed("adaptive", "the number of draws is fixed; set iterations and first_iterations");
  describe_contact_epsilon(v, p.contact_epsilon);
  v.field("min_contact", p.min_contact,
          {.doc = "Contact a pose needs before it is refined: the right one may have little then.",
           .min = 0.0,
           .max = 1.0,
           .audience = Audience::tuner});
  v.field("candidates", p.candidates,
          {.doc = "Distinct poses that are refined and judged.",
           .min = 1,
           .max = 10000,
           .audience = Audience::expert,
           .formerly = "modes"});
  v.field("best", p.best,
          {.doc = "Number of candidates that become hypotheses: those with the highest scores.",
           .min = 1,
           .max = 10000,
           .audience = Audience::expert});
  v.field("carried", p.carried,
          {.doc = "Number of hypotheses carried on to the next step: those with the highest scores.",
           .min = 0,
           .max = 10000,
           .audience = Audience::expert});
  v.field("refinement", p.refinement,
          {.doc = "How poses are refined on the distance field.", .audience = Audience::expert});
  describe(v, p.beams);
  v.field("unknown_weight", p.unknown_weight,
          {.doc = "What the share of points in unknown cells adds to the score.",
           .min = 0.0,
           .max = 1.0,
           .audience = Audience::expert});
  v.field("min_length", p.min_length,
          {.doc = "Shortest oriented point pair, or side of a triangle.",
           .unit = "m",
           .max = 5.0,
           .above = 0.0,
           .audience = Audience::expert});
  v.field("relation", p.relation,
          {.doc = "What is drawn and sorted: two points with their normals, three points, or three where few "
                  "have normals.",
           .choices = {"oriented_pair", "triangle", "auto"},
           .former_choices = {{"dipole", "oriented_pair"}}});
  v.field(
      "exact_search", p.exact_search,
      {.doc = "When an exact search of the whole map, on boxes of poses as the verifier whole_map makes it, "
              "adds its poses.",
       .audience = Audience::expert});
  v.removed("space", "in space the matcher surfel_ransam searches, which has these keys itself");
}

IndexedRansam::IndexedRansam(const Params& params, const StageSetup& setup)
    : params_(params),
      map_(setup.map),
      relation_(relation_rule(params)),
      index_(built_index(setup.threads)),
      proposals_(proposals_on(points_of(*index_), params.iterations)),
      contact_(contact_index(*map_, "bitset", setup.epsilon(params.contact_epsilon), setup.threads)),
      refiner_(static_cast<std::size_t>(params.candidates), params.refinement,
               distance_field(*map_, setup.threads), contact_),
      judge_(judge_rule(params, setup.epsilon(params.contact_epsilon)), map_, contact_,
             distance_field(*map_, setup.threads), setup.threads),
      exact_search_(params.exact_search, *map_, setup.epsilon(params.contact_epsilon), setup.threads),
      looks_per_step_(setup.looks_per_step) {}

IndexedRansam::OpenStep::OpenStep(Points some_points, const MatchRequest& request,
                                  const ContactIndex& contact, const Params& params)
    : sample(std::move(some_points)),
      gate(request.gate),
      omega_max(request.omega_max),
      candidates(contact, sample, params.min_contact,
                 proposals_per_candidate * static_cast<std::size_t>(params.candidates), gate) {}

std::shared_ptr<const RelationIndex> IndexedRansam::built_index(int threads) {
  const auto start = std::chrono::steady_clock::now();
  auto built = relation_index(*map_, relation_, threads);
  const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
  map_index_ = std::visit(
      [&](const auto& index) {
        return MapIndexInfo{index.size(), index.memory_bytes(), time.count()};
      },
      *built);
  return built;
}

std::size_t IndexedRansam::proposals_on(std::size_t points, int iterations) {
  constexpr double points_per_iterations = 80000.0;
  constexpr int most = 24000;
  const double proposals = iterations * std::max(1.0, static_cast<double>(points) / points_per_iterations);
  return static_cast<std::size_t>(std::min<double>(proposals, std::max(iterations, most)));
}

void IndexedRansam::reset() {
  judge_.forget();
  exact_search_.reset();
  open_.reset();
  carried_.clear();
  epoch_ = 0;
  steps_ = 0;
}

MatchResult IndexedRansam::match(const MatchRequest& request, Rng& rng) {
  const LocalMap& local = request.local;
  if (local.points.empty()) return {};
  if (local.epoch != epoch_) reset();
  epoch_ = local.epoch;
  judge_.take_in(local, request.latest.scan);
  open_ =
      std::make_unique<OpenStep>(sample_of(local.points, contact_points, rng), request, *contact_, params_);
  OpenStep& step = *open_;
  for (const Pose2& pose : carried_) step.candidates.add(pose);
  propose(*index_, relation_, local, proposals_of_step(), rng,
          [&](const MotionBatch& poses, std::size_t size) { step.candidates.test(poses, size); });
  settle(step, local);
  if (exact_search_.is_due(step.best)) {
    exact_search_.begin(sample_of(local.points, exact_search_.points(), rng),
                        seen_from_above(local.local_from_robot), request.gate);
  }
  return go_on(local, looks_per_step_);
}

MatchResult IndexedRansam::go_on(const LocalMap& local, std::size_t looks) {
  OpenStep& step = *open_;
  const std::size_t looked_at = exact_search_.advance(step.best, looks, [&](const std::vector<Pose2>& poses) {
    for (const Pose2& pose : poses) step.candidates.add(pose);
    step.proposals += poses.size();
    settle(step, local);
    return step.best;
  });
  step.points_tested += looked_at;
  MatchResult result{.hypotheses = {},
                     .proposals = step.proposals + step.candidates.tested(),
                     .points_tested = step.points_tested + step.candidates.points_tested(),
                     .goes_on = exact_search_.goes_on()};
  carried_.clear();
  for (const Hypothesis& h : step.best) {
    if (carried_.size() < static_cast<std::size_t>(params_.carried))
      carried_.push_back(seen_from_above(h.map_from_local));
    if (h.score >= step.omega_max) result.hypotheses.push_back(judge_.to_hypothesis(h, local, step.sample));
  }
  return result;
}

std::vector<Hypothesis> IndexedRansam::rescore(std::vector<Hypothesis> found, const LocalMap& local) {
  std::vector<Candidate> candidates;
  for (const Hypothesis& h : found) candidates.push_back({seen_from_above(h.map_from_local), h.quality});
  found = judge_.best_of(candidates, local, local.points);
  for (Hypothesis& h : found) {
    carried_.push_back(seen_from_above(h.map_from_local));
    h = judge_.to_hypothesis(h, local, local.points);
    h.score = std::max(h.score, 0.0);
  }
  return found;
}

/// More in the first steps, when nothing is carried yet.
std::size_t IndexedRansam::proposals_of_step() {
  const bool is_first = steps_++ < first_steps;
  return is_first ? std::max(static_cast<std::size_t>(params_.first_iterations), proposals_) : proposals_;
}

/// Leaves the distinct candidates, refined, and the best of them.
void IndexedRansam::settle(OpenStep& step, const LocalMap& local) const {
  step.candidates.refine(refiner_, seen_from_above(local.local_from_robot));
  step.points_tested += step.candidates.all().size() * local.points.size();
  step.best = judge_.best_of(step.candidates.all(), local, step.sample);
}

}  // namespace glocal::indexed_ransam
