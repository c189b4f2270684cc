#include "matchers/indexed_ransam/pose_judge.hpp"

#include <algorithm>
#include <utility>

namespace glocal {
namespace {

/// Share of the points for which a condition holds: of the cell they fall into, and of where a pose puts
/// them.
template <class Condition>
double share_where(const OccupancyGrid& grid, const Points& points, const Pose2& map_from_points,
                   Condition condition) {
  const Transform map(map_from_points);
  const CellsUnder cell_under(grid, map_from_points);
  std::size_t count = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    count += condition(cell_under(points[i]), map(points[i])) ? 1 : 0;
  return static_cast<double>(count) / static_cast<double>(points.size());
}

bool has_better_score(const Hypothesis& a, const Hypothesis& b) {
  return a.score > b.score;
}

}  // namespace

PoseJudge::PoseJudge(const JudgeRule& rule, std::shared_ptr<const GlobalMap> map,
                     std::shared_ptr<const ContactIndex> contact, std::shared_ptr<const DistanceField> field)
    : rule_(rule),
      map_(std::move(map)),
      contact_(std::move(contact)),
      field_(std::move(field)),
      clearance_(clearance_grid(*map_)),
      beams_(rule.beams) {}

/// Beams take most of the time, and only take from a score: candidates are looked at in the order of what
/// they could reach, until no other one can be among the best.
std::vector<Hypothesis> PoseJudge::best_of(const std::vector<Candidate>& candidates, const LocalMap& local,
                                           const Points& sample) const {
  std::vector<Hypothesis> at_most;
  for (const Candidate& candidate : candidates) {
    Hypothesis h = Hypothesis::by_contact(candidate.map_from_local,
                                          contact_->share(local.points, Transform(candidate.map_from_local)));
    h.score += rule_.unknown_weight * unknown_share(sample, candidate.map_from_local) -
               rule_.fit_weight * misfit(sample, candidate.map_from_local);
    if (rule_.free_weight > 0.0)
      h.score -= rule_.free_weight * free_space_violation(sample, candidate.map_from_local);
    at_most.push_back(h);
  }
  std::stable_sort(at_most.begin(), at_most.end(), has_better_score);
  std::vector<Hypothesis> best;
  for (Hypothesis& h : at_most) {
    if (best.size() == rule_.most && best.back().score >= h.score) break;
    h.score -= beams_.penalty(*clearance_, seen_from_above(h.map_from_local));
    best.insert(std::upper_bound(best.begin(), best.end(), h, has_better_score), h);
    if (best.size() > rule_.most) best.pop_back();
  }
  return best;
}

Hypothesis PoseJudge::told(Hypothesis judged, const LocalMap& local, const Points& sample) const {
  const Pose2 map_from_local = seen_from_above(judged.map_from_local);
  const Pose2 map_from_robot = map_from_local * seen_from_above(local.local_from_robot);
  judged.score = std::min(judged.score, 1.0);
  judged.covariance =
      pose_covariance(*field_, sample, map_from_local, map_from_robot, rule_.kernel, rule_.uncertainty);
  judged.free_space_violation = free_space_violation(sample, map_from_local);
  return judged;
}

double PoseJudge::unknown_share(const Points& sample, const Pose2& map_from_local) const {
  if (rule_.unknown_weight == 0.0) return 0.0;
  return share_where(map_->grid(), sample, map_from_local,
                     [](Cell cell, const Point& /*p*/) { return cell == Cell::unknown; });
}

double PoseJudge::misfit(const Points& sample, const Pose2& map_from_local) const {
  if (rule_.fit_weight == 0.0) return 0.0;
  const Transform map(map_from_local);
  double sum = 0.0;
  for (std::size_t i = 0; i < sample.size(); ++i) {
    const Point p = map(sample[i]);
    sum += std::min(1.0, field_->at(p.x, p.y).distance / rule_.contact_epsilon);
  }
  return sum / static_cast<double>(sample.size());
}

double PoseJudge::free_space_violation(const Points& sample, const Pose2& map_from_local) const {
  return share_where(map_->grid(), sample, map_from_local, [&](Cell cell, const Point& p) {
    return cell == Cell::free && field_->at(p.x, p.y).distance > rule_.contact_epsilon;
  });
}

}  // namespace glocal
