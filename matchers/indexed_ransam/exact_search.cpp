#include "matchers/indexed_ransam/exact_search.hpp"

#include "matchers/grid_search/grid_search.hpp"

namespace glocal {

void describe(ParamVisitor& v, ExactSearchRule& p) {
  v.field("after_steps", p.after_steps,
          {.doc = "An exact search follows the last of so many steps in a row without a clear best pose; 0 "
                  "never searches.",
           .min = 0});
  v.field("margin", p.margin,
          {.doc = "The best pose is clear if no other pose has a score within this of its own.",
           .min = 0.0,
           .max = 1.0});
  v.field("cell", p.cell,
          {.doc = "Translations are multiples of this; at most contact_epsilon.",
           .unit = "m",
           .min = 0.01,
           .max = 1.0});
  v.field("min_rotation_step_deg", p.min_rotation_step_deg,
          {.doc = "Smallest step between rotations; a step moves the farthest point by one cell otherwise.",
           .unit = "deg",
           .min = 0.005,
           .max = 5.7,
           .formerly = "min_rotation_step"});
  v.field("max_poses", p.max_poses,
          {.doc = "Largest number of poses that the search adds.", .min = 1, .max = 10000});
}

ExactSearch::ExactSearch(const ExactSearchRule& rule, const CandidateRule& candidate, double min_contact,
                         const GlobalMap& map, double contact_epsilon, int threads)
    : rule_(rule),
      grid_{.min_quality = min_contact,
            .min_rotation_step = radians(rule.min_rotation_step_deg),
            .distance = candidate.distance,
            .rotation = radians(candidate.rotation_deg),
            .max_poses = static_cast<std::size_t>(rule.max_poses)},
      pyramid_(rule.after_steps > 0 ? contact_pyramid(map, rule.cell, contact_epsilon) : nullptr),
      threads_(threads) {}

bool ExactSearch::is_due(const std::vector<Hypothesis>& best) {
  const bool is_clear =
      best.size() == 1 || (best.size() > 1 && best[0].score - best[1].score >= rule_.margin);
  undecided_ = is_clear ? 0 : undecided_ + 1;
  if (!pyramid_ || undecided_ < rule_.after_steps) return false;
  undecided_ = 0;
  return true;
}

GridSearchResult ExactSearch::search(const Points& points, const Pose2& local_from_robot,
                                     const PoseGate& gate) const {
  GridSearchRule rule = grid_;
  rule.gate = gate;
  return search_grid(*pyramid_, points, local_from_robot, rule, threads_);
}

}  // namespace glocal
