#include "matchers/indexed_ransam/pose_judge.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>

namespace glocal::indexed_ransam {

PoseJudge::PoseJudge(const JudgeRule& rule, std::shared_ptr<const GlobalMap> map,
                     std::shared_ptr<const ContactIndex> contact, std::shared_ptr<const DistanceField> field,
                     int threads)
    : rule_(rule),
      map_(std::move(map)),
      contact_(std::move(contact)),
      field_(std::move(field)),
      clearance_(clearance_grid(*map_, threads)),
      beams_(rule.beams) {}

/// Beams take most of the time, and only take from a score: candidates are looked at in the order of what
/// they could reach, until no other one can be among the best.
std::vector<Hypothesis> PoseJudge::best_of(const std::vector<Candidate>& candidates, const LocalMap& local,
                                           const Points& sample) const {
  std::vector<Hypothesis> at_most;
  LookUps memory;
  for (const Candidate& candidate : candidates) {
    Hypothesis h = Hypothesis::by_contact(candidate.map_from_local,
                                          contact_->share(local.points, Transform(candidate.map_from_local)));
    const PlaceEvidence evidence = evidence_at(candidate.map_from_local, sample, memory);
    h.score += rule_.unknown_weight * evidence.unknown - rule_.fit_weight * evidence.misfit;
    h.score -= rule_.free_space_weight * evidence.in_free_space;
    at_most.push_back(h);
  }
  std::ranges::stable_sort(at_most, std::greater<>(), &Hypothesis::score);
  std::vector<Hypothesis> best;
  for (Hypothesis& h : at_most) {
    const bool is_full = best.size() == rule_.most;
    if (is_full && best.back().score >= h.score) break;
    const double to_lose = is_full ? h.score - best.back().score : std::numeric_limits<double>::infinity();
    h.score -= beams_.penalty(*clearance_, seen_from_above(h.map_from_local), to_lose);
    best.insert(std::ranges::upper_bound(best, h.score, std::greater<>(), &Hypothesis::score), h);
    if (best.size() > rule_.most) best.pop_back();
  }
  return best;
}

Hypothesis PoseJudge::to_hypothesis(Hypothesis judged, const LocalMap& local, const Points& sample) const {
  const Pose2 map_from_local = seen_from_above(judged.map_from_local);
  const Pose2 map_from_robot = map_from_local * seen_from_above(local.local_from_robot);
  judged.score = std::min(judged.score, 1.0);
  judged.covariance = pose_covariance(*field_, sample, map_from_local, map_from_robot, rule_.kernel);
  LookUps memory;
  judged.free_space_violation = evidence_at(map_from_local, sample, memory).in_free_space;
  judged.beam_evidence = beams_.support(*contact_, *clearance_, map_from_local);
  return judged;
}

PoseJudge::PlaceEvidence PoseJudge::evidence_at(const Pose2& map_from_local, const Points& sample,
                                                LookUps& memory) const {
  CellsUnder(map_->grid(), map_from_local).find(sample, memory.cells);
  field_->at(sample, Transform(map_from_local), memory.field);
  std::size_t in_unknown = 0, in_free_space = 0;
  double misfit = 0.0;
  for (std::size_t i = 0; i < sample.size(); ++i) {
    const Cell cell = memory.cells[i];
    const double to_map = memory.field.distance[i];
    in_unknown += cell == Cell::unknown ? 1U : 0U;
    in_free_space += cell == Cell::free && to_map > rule_.contact_epsilon ? 1U : 0U;
    misfit += std::min(1.0, to_map / rule_.contact_epsilon);
  }
  const auto size = static_cast<double>(sample.size());
  return {.unknown = static_cast<double>(in_unknown) / size,
          .in_free_space = static_cast<double>(in_free_space) / size,
          .misfit = misfit / size};
}

}  // namespace glocal::indexed_ransam
