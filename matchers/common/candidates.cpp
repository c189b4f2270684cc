#include "matchers/common/candidates.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>

namespace glocal {
namespace {

Points first_of(const Points& points, std::size_t n) {
  Points first;
  for (std::size_t i = 0; i < std::min(n, points.size()); ++i) first.push_back(points[i]);
  return first;
}

}  // namespace

void describe(ParamVisitor& v, CandidateRule& p) {
  v.field("candidate_distance", p.distance,
          {.doc = "Robot poses are one candidate if they are nearer to each other than this, and turned by "
                  "less than candidate_rotation_deg.",
           .unit = "m",
           .above = 0.0,
           .audience = Audience::expert,
           .formerly = "mode_distance"});
  v.field("candidate_rotation_deg", p.rotation_deg,
          {.doc = "Robot poses are one candidate if they are turned by less than this, and nearer to each "
                  "other than candidate_distance.",
           .unit = "deg",
           .above = 0.0,
           .audience = Audience::expert,
           .formerly = "mode_rotation"});
  v.field("refinement_points", p.refinement_points,
          {.doc = "Points used to refine a pose.", .min = 3, .audience = Audience::expert});
}

CandidateRefiner::CandidateRefiner(const CandidateRule& rule, std::size_t most,
                                   const PoseRefinement& refinement,
                                   std::shared_ptr<const DistanceField> field,
                                   std::shared_ptr<const ContactIndex> contact)
    : rule_(rule),
      most_(most),
      refinement_(refinement),
      field_(std::move(field)),
      contact_(std::move(contact)) {}

std::vector<Candidate> CandidateRefiner::refined(std::vector<Candidate> candidates,
                                                 const Pose2& local_from_robot, const Points& sample,
                                                 const Points& points) const {
  const Points anchors = first_of(sample, static_cast<std::size_t>(rule_.refinement_points));
  candidates = distinct_candidates(std::move(candidates), local_from_robot, rule_, most_);
  for (Candidate& candidate : candidates) {
    candidate.map_from_local = refined_pose(*field_, anchors, candidate.map_from_local, refinement_);
    candidate.quality = contact_->share(points, Transform(candidate.map_from_local));
  }
  return distinct_candidates(std::move(candidates), local_from_robot, rule_, most_);
}

std::vector<std::uint32_t> draw_numbers(std::size_t n, std::size_t below, Rng& rng) {
  std::vector<std::uint32_t> numbers(below);
  std::iota(numbers.begin(), numbers.end(), 0U);
  const std::size_t size = std::min(n, below);
  for (std::size_t i = 0; i < size; ++i) {
    std::swap(numbers[i], numbers[i + rng.below(static_cast<std::uint32_t>(below - i))]);
  }
  numbers.resize(size);
  return numbers;
}

Points sample_of(const Points& points, std::size_t n, Rng& rng) {
  Points sample;
  for (const std::uint32_t i : draw_numbers(n, points.size(), rng)) sample.push_back(points[i]);
  return sample;
}

}  // namespace glocal
