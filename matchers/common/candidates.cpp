#include "matchers/common/candidates.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>

namespace glocal {
namespace {

/// They hold all three directions of a pose; more move it by less than the map's cells.
constexpr std::size_t refinement_points = 50;

Points first_of(const Points& points, std::size_t n) {
  Points first;
  for (std::size_t i = 0; i < std::min(n, points.size()); ++i) first.push_back(points[i]);
  return first;
}

}  // namespace

CandidateRefiner::CandidateRefiner(std::size_t most, const PoseRefinement& refinement,
                                   std::shared_ptr<const DistanceField> field,
                                   std::shared_ptr<const ContactIndex> contact)
    : most_(most), refinement_(refinement), field_(std::move(field)), contact_(std::move(contact)) {}

std::vector<Candidate> CandidateRefiner::refined(std::vector<Candidate> candidates,
                                                 const Pose2& local_from_robot, const Points& sample,
                                                 const Points& points) const {
  const Points anchors = first_of(sample, refinement_points);
  candidates = distinct_candidates(std::move(candidates), local_from_robot, most_);
  for (Candidate& candidate : candidates) {
    candidate.map_from_local = refined_pose(*field_, anchors, candidate.map_from_local, refinement_);
    candidate.quality = contact_->share(points, Transform(candidate.map_from_local));
  }
  return distinct_candidates(std::move(candidates), local_from_robot, most_);
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
