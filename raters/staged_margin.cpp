#include "raters/staged_margin.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace glocal {

void describe(ParamVisitor& v, StagedMargin::Stage& p) {
  v.field("margin", p.margin,
          {.doc = "Quality of the best hypothesis less that of its best rival, at least.",
           .min = 0.0,
           .max = 1.0});
  v.field("steps", p.steps, {.doc = "In so many consecutive steps.", .min = 1});
  v.field("distance", p.distance, {.doc = "And over this way.", .unit = "m", .min = 0.0});
}

void describe(ParamVisitor& v, StagedMargin::Params& p) {
  v.field("stages", p.stages, {.doc = "Any of them is enough.", .min_items = 1, .max_items = 100});
  v.field("rival_distance", p.rival_distance,
          {.doc = "A hypothesis is a rival of the best one if it is farther away than this.",
           .unit = "m",
           .above = 0.0});
  v.field("rival_rotation_deg", p.rival_rotation_deg,
          {.doc = "… or turned by more.", .unit = "deg", .max = 180.0, .above = 0.0});
  v.field("same_distance", p.same_distance,
          {.doc = "The best hypothesis is the same as in the last step if its robot pose, moved by the local "
                  "motion, is "
                  "nearer.",
           .unit = "m",
           .above = 0.0});
  v.field("same_rotation_deg", p.same_rotation_deg,
          {.doc = "… and turned by less.", .unit = "deg", .max = 180.0, .above = 0.0});
  v.field("candidate_margin", p.candidate_margin,
          {.doc = "The verdict is ambiguous if rivals are so near in quality to the best hypothesis.",
           .min = 0.0,
           .max = 1.0});
  v.field("max_candidates", p.max_candidates, {.doc = "With more, nothing can be said yet.", .min = 2});
}

void StagedMargin::reset() {
  leads_.assign(params_.stages.size(), {});
  best_.reset();
}

Verdict StagedMargin::judge(const StepResult& step) {
  if (step.hypotheses.empty()) {
    reset();
    return {VerdictKind::searching, std::nullopt, {}, "no pose fits the local map well enough in this step"};
  }
  const double driven = best_ ? distance(best_->local_from_robot, step.local_from_robot) : 0.0;
  if (!continues(step)) reset();
  const Pose2& pose = step.hypotheses.front().map_from_robot;
  best_ = FollowedPose::of(step, pose);

  const double lead_now = margin(step);
  for (std::size_t i = 0; i < params_.stages.size(); ++i) {
    const StagedMargin::Stage& stage = params_.stages[i];
    Lead& lead = leads_[i];
    if (lead_now < stage.margin) {
      lead = {};
      continue;
    }
    lead.distance += lead.steps > 0 ? driven : 0.0;
    ++lead.steps;
    if (lead.steps < stage.steps || lead.distance < stage.distance) continue;
    return {VerdictKind::localized,
            pose,
            {},
            fmt::format("better by {:.2f} than any other pose, and by {:.2f} in {} steps over {:.1f} m",
                        lead_now, stage.margin, lead.steps, lead.distance)};
  }
  std::vector<Pose2> poses = candidates(step);
  const std::size_t n = poses.size();
  if (n >= 2 && n <= static_cast<std::size_t>(params_.max_candidates)) {
    return {VerdictKind::ambiguous, std::nullopt, std::move(poses),
            fmt::format("{} poses explain the observations about equally well", n)};
  }
  return {VerdictKind::searching,
          std::nullopt,
          {},
          fmt::format("the best pose is better by {:.2f} only", lead_now)};
}

bool StagedMargin::are_rivals(const Pose2& a, const Pose2& b) const {
  return distance(a, b) > params_.rival_distance ||
         rotation_between(a, b) > radians(params_.rival_rotation_deg);
}

/// Poses below Omega_max are not among the hypotheses: without a rival there, the best one may still have it.
double StagedMargin::margin(const StepResult& step) const {
  const Hypothesis& best = step.hypotheses.front();
  const auto rival = std::find_if(step.hypotheses.begin(), step.hypotheses.end(), [&](const Hypothesis& h) {
    return are_rivals(h.map_from_robot, best.map_from_robot);
  });
  return best.quality - (rival == step.hypotheses.end() ? step.omega_max : rival->quality);
}

bool StagedMargin::continues(const StepResult& step) const {
  const auto expected = best_ ? best_->expected_in(step) : std::nullopt;
  return expected && are_same(step.hypotheses.front().map_from_robot, *expected, params_.same_distance,
                              params_.same_rotation_deg);
}

/// The best pose and its rivals of about the same quality, each a rival of the others.
std::vector<Pose2> StagedMargin::candidates(const StepResult& step) const {
  std::vector<Pose2> poses;
  for (const Hypothesis& h : step.hypotheses) {
    if (h.quality < step.hypotheses.front().quality - params_.candidate_margin) break;
    const bool repeats = std::any_of(
        poses.begin(), poses.end(), [&](const Pose2& other) { return !are_rivals(h.map_from_robot, other); });
    if (!repeats) poses.push_back(h.map_from_robot);
  }
  return poses;
}

}  // namespace glocal
