#include "raters/staged_margin.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "raters/candidates.hpp"

namespace glocal::raters {
namespace {

/// Steps since the robot last turned fast, before anything is declared.
constexpr int steady_steps = 3;

/// Poses that are not near each other are rivals.
constexpr PoseTolerance near;
/// The verdict is ambiguous if the score of a rival is within this of the best one.
constexpr double candidate_margin = 0.10;

/// m. A robot that is no farther from where it was sees the same again, whatever way it has turned.
constexpr double standing = 0.05;

/// A declared pose stays declared while its confidence is at least this.
constexpr double confidence_to_stay = 0.965;
/// Steps over which the margin is averaged: in one of them a rival may be missed.
constexpr int steps_of_mean_margin = 10;
/// A scan has lost the best pose if it has a smaller share of the contact that scans have had there so far.
constexpr double least_of_usual_contact = 0.7;
/// Places from which the best pose has been the same, before a confidence is enough.
constexpr int first_views_to_be_sure = 2;
/// No refutation asks for more.
constexpr int most_views_to_be_sure = 1024;

/// A scan that fits less well says that the robot is perhaps on another floor, and what was thought before is
/// worth nothing.
constexpr double least_contact_where_expected = 0.9;

/// Logarithm of the odds for the best pose that come from where the robot was thought to be.
double log_odds_before(const StepResult& step) {
  const bool is_expected =
      step.expected && step.omega_scan.value_or(0.0) >= least_contact_where_expected &&
      near.are_near(step.hypotheses.front().map_from_robot, step.expected->map_from_robot);
  return is_expected ? std::log(step.expected->odds) : 0.0;
}

/// What the confidence is made of.
struct Evidence {
  double margin;                    ///< In this step.
  double mean_margin;               ///< In the latest steps in which the best pose has been the same.
  int views;                        ///< Places from which it has been the same.
  double contact;                   ///< Of the local map, at the best pose.
  std::optional<double> beam_lead;  ///< How much more beams say for it than for any rival.
};

/// The probability that the best pose is right: logistic in its mean margin, in the logarithm of the views
/// times the contact, as they speak for a pose only where the local map fits, and in the lead. Fitted to
/// starts in disturbed worlds, one in ten of them on a wrong map; without beams, in the last margin, to
/// starts in clean worlds (docs/method.md). Never 1, however clear the margin is: a place off the map has no
/// hypothesis.
double confidence_of(const Evidence& e, double log_odds_before) {
  const double views = std::log(std::max(e.views, 1));  // none yet, where the step's scan is empty
  const double seen = e.beam_lead
                          ? -2.74 + 31.93 * e.mean_margin + 1.204 * e.contact * views + 0.713 * *e.beam_lead
                          : -1.5 + 28.5 * e.margin + 0.45 * views;
  return 0.998 / (1.0 + std::exp(-seen - log_odds_before));
}

/// How much more beams say for the best pose than for any rival; 0 without a rival.
std::optional<double> beam_lead(const std::vector<Hypothesis>& hypotheses) {
  const Hypothesis& best = hypotheses.front();
  if (!best.beam_evidence) return std::nullopt;
  double lead = std::numeric_limits<double>::infinity();
  for (const Hypothesis& h : hypotheses) {
    if (h.beam_evidence && !near.are_near(h.map_from_robot, best.map_from_robot))
      lead = std::min(lead, *best.beam_evidence - *h.beam_evidence);
  }
  return std::isfinite(lead) ? lead : 0.0;
}

/// The best hypothesis' own, and the spread of those near it that are about as good.
std::optional<PoseCovariance> covariance(const std::vector<Hypothesis>& hypotheses) {
  constexpr double spread_margin = 0.05;  // in score, at which a hypothesis counts 1/e
  const Hypothesis& best = hypotheses.front();
  if (!best.covariance) return std::nullopt;
  const double heading = best.map_from_robot.heading();
  PoseCovariance spread;
  double weights = 0.0;
  for (const Hypothesis& h : hypotheses) {
    if (!near.are_near(h.map_from_robot, best.map_from_robot)) continue;
    const double weight = std::exp((h.score - best.score) / spread_margin);
    const double x = h.map_from_robot.x - best.map_from_robot.x;
    const double y = h.map_from_robot.y - best.map_from_robot.y;
    const double t = wrap_angle(h.map_from_robot.heading() - heading);
    weights += weight;
    spread.xx += weight * x * x;
    spread.xy += weight * x * y;
    spread.xt += weight * x * t;
    spread.yy += weight * y * y;
    spread.yt += weight * y * t;
    spread.tt += weight * t * t;
  }
  const PoseCovariance& own = *best.covariance;
  return PoseCovariance{own.xx + spread.xx / weights, own.xy + spread.xy / weights,
                        own.xt + spread.xt / weights, own.yy + spread.yy / weights,
                        own.yt + spread.yt / weights, own.tt + spread.tt / weights};
}

}  // namespace

void describe(ParamVisitor& v, StagedMargin::Stage& p) {
  v.field(
      "margin", p.margin,
      {.doc = "Score of the best hypothesis less that of its best rival, at least.", .min = 0.0, .max = 1.0});
  v.field("steps", p.steps,
          {.doc = "Number of consecutive steps in which the margin must be kept.", .min = 1});
  v.field("distance", p.distance,
          {.doc = "Way the robot must drive while the margin is kept.", .unit = "m", .min = 0.0});
}

void describe(ParamVisitor& v, StagedMargin::Params& p) {
  v.field("stages", p.stages,
          {.doc = "Margins to be kept for a while; any one of them is enough for a declaration.",
           .min_items = 1,
           .max_items = 100,
           .audience = Audience::tuner});
  v.field(
      "certified_stages", p.certified_stages,
      {.doc = "Margins that are enough, too, where localizer.verifier certifies that no pose elsewhere has "
              "more contact.",
       .max_items = 100,
       .audience = Audience::tuner});
  v.field("max_turn_rate_deg", p.max_turn_rate_deg,
          {.doc = "Nothing is declared while the robot turns faster than this, nor in the two steps after: "
                  "scans are smeared then, and time stamps are not exact enough for the heading.",
           .unit = "deg/s",
           .above = 0.0,
           .audience = Audience::expert});
  v.field("max_free_space_violation", p.max_free_space_violation,
          {.doc = "No margin is enough if a larger share of the points lies in space known to be free, where "
                  "the matcher tells that share.",
           .min = 0.0,
           .max = 1.0,
           .audience = Audience::tuner,
           .formerly = "max_conflict"});
  v.field(
      "min_scan_contact", p.min_scan_contact,
      {.doc = "Margins count anew after a step whose own scan has less contact at the best pose, however "
              "well the local map fits: the robot is perhaps no longer there. All begins anew where that is "
              "less than 0.7 of what it was.",
       .min = 0.0,
       .max = 1.0,
       .audience = Audience::tuner});
  v.field(
      "min_confidence", p.min_confidence,
      {.doc = "A pose is declared, too, once its confidence is at least this, where the matcher tells what "
              "beams say and localizer.verifier looks for rivals; 1 is never reached.",
       .min = 0.0,
       .max = 1.0,
       .audience = Audience::tuner});
}

StagedMargin::StagedMargin(const Params& params, const StageSetup& setup)
    : params_(params),
      stages_(params.stages),
      certified_stages_(setup.has_verifier ? params.certified_stages : std::vector<Stage>{}),
      has_verifier_(setup.has_verifier),
      views_to_be_sure_(first_views_to_be_sure) {}

/// A rival that was not known of was there all the time, so no margin has been kept. Without one there is
/// another chance to be certified once a stage is reached anew.
void StagedMargin::refute(const Verification& verification) {
  certified_stages_.begin_anew();
  is_declared_ = false;
  views_to_be_sure_ = std::min(2 * views_to_be_sure_, most_views_to_be_sure);
  const bool has_rival =
      !verification.rivals.empty() && verification.is_about_as_good(verification.rivals.front());
  if (has_rival || !verification.certificate) begin_anew();
}

void StagedMargin::reset() {
  begin_anew();
  best_.reset();
  last_step_.reset();
  since_turn_.reset();
  views_to_be_sure_ = first_views_to_be_sure;
}

void StagedMargin::begin_anew() {
  begin_stages_anew();
  steps_ = 0;
  views_ = 0;
  mean_margin_ = 0.0;
  distance_ = 0.0;
  sum_of_contact_ = 0.0;
  is_declared_ = false;
}

void StagedMargin::begin_stages_anew() {
  stages_.begin_anew();
  certified_stages_.begin_anew();
}

Verdict StagedMargin::judge(const StepResult& step) {
  follow_turn(step);
  const bool is_steady_now = is_steady();
  if (step.hypotheses.empty()) {
    begin_anew();
    best_.reset();
    return {.kind = VerdictKind::searching, .why = "no pose fits the local map well enough in this step"};
  }
  const Pose3& pose = step.hypotheses.front().map_from_robot;
  const bool goes_on = best_ && best_->may_be(pose, step);
  const double driven = goes_on ? distance(best_->local_from_robot, step.local_from_robot) : 0.0;
  // Of hardly a point, a stray one would be much.
  const double contact = step.saw_nothing ? 1.0 : step.omega_scan.value_or(1.0);
  const bool scan_fits = contact >= params_.min_scan_contact;
  const bool is_usual = scan_fits || contact * steps_ >= least_of_usual_contact * sum_of_contact_;
  if (!goes_on || !is_usual) begin_anew();
  if (!scan_fits) begin_stages_anew();
  best_ = FollowedPose::of(step, pose);
  const double margin = margin_of(step);
  // A scan with hardly a point leaves the local map as it was: the same answer again says nothing new.
  const bool is_look = !step.saw_nothing;
  if (is_look) count(step, margin, driven, contact);
  const bool is_clear = scan_fits && stages_.is_reached(margin, driven, is_look);
  const bool is_clear_if_certified = scan_fits && certified_stages_.is_reached(margin, driven, is_look);
  const std::optional<double>& violation = step.hypotheses.front().free_space_violation;
  const bool is_consistent = !violation || *violation <= params_.max_free_space_violation;
  const std::optional<double> lead = beam_lead(step.hypotheses);
  const Evidence evidence{margin, mean_margin_, views_, step.hypotheses.front().quality, lead};
  const double confidence = confidence_of(evidence, log_odds_before(step));
  const bool is_sure = is_steady_now && has_verifier_ && lead && views_ >= views_to_be_sure_ &&
                       confidence >= params_.min_confidence;
  const bool may_be_declared = is_steady_now && is_consistent;
  if (is_sure || (may_be_declared && (is_clear || is_clear_if_certified))) is_declared_ = true;
  const bool is_lost = stages_.is_lost() && certified_stages_.is_lost();
  if (is_lost && !(lead && confidence >= confidence_to_stay)) is_declared_ = false;
  Verdict verdict = is_declared_ ? localized(step, margin) : undecided(step, margin);
  if (!scan_fits && !is_declared_)
    verdict.why = fmt::format("only {:.0f} % of the last scan fits the best pose", 100.0 * *step.omega_scan);
  verdict.needs_certificate = is_declared_ && !is_sure && !(may_be_declared && is_clear);
  verdict.estimate = {pose, confidence, covariance(step.hypotheses)};
  verdict.evidence = {{"margin", margin},
                      {"steps", static_cast<double>(steps_)},
                      {"distance_m", distance_},
                      {"turn_rate_deg", turn_rate_deg_}};
  if (violation) verdict.evidence.push_back({"free_space_violation", *violation});
  if (lead) verdict.evidence.push_back({"beam_lead", *lead});
  return verdict;
}

/// A step in which the best pose is the same.
void StagedMargin::count(const StepResult& step, double margin, double driven, double contact) {
  ++steps_;
  if (views_ == 0 || distance(step.local_from_robot, last_view_) > standing) {
    ++views_;
    last_view_ = step.local_from_robot;
  }
  distance_ += driven;
  sum_of_contact_ += contact;
  mean_margin_ += (margin - mean_margin_) / std::min(steps_, steps_of_mean_margin);
}

/// Takes in how fast the robot has turned since the last step. Where stamps stand still the robot is taken to
/// turn on as it did.
void StagedMargin::follow_turn(const StepResult& step) {
  if (last_step_ && last_step_->epoch == step.local_map_epoch && last_step_->stamp == step.stamp) return;
  turn_rate_deg_ = last_step_ ? degrees(last_step_->turn_rate_to(step)) : 0.0;
  last_step_ = FollowedPose::of(step, {});
}

/// Counts steps since the last fast turn.
bool StagedMargin::is_steady() {
  if (turn_rate_deg_ > params_.max_turn_rate_deg) {
    since_turn_ = 0;
  } else if (since_turn_) {
    ++*since_turn_;
  }
  return !since_turn_ || *since_turn_ >= steady_steps;
}

bool StagedMargin::Stages::is_reached(double margin, double driven, bool is_look) {
  bool reached = false;
  for (std::size_t i = 0; i < stages_.size(); ++i) {
    const Stage& stage = stages_[i];
    Kept& kept = kept_[i];
    if (margin < stage.margin) {
      kept = {};
      continue;
    }
    if (is_look) {
      kept.distance += kept.steps > 0 ? driven : 0.0;
      ++kept.steps;
    }
    reached = reached || (kept.steps >= stage.steps && kept.distance >= stage.distance);
  }
  return reached;
}

bool StagedMargin::Stages::is_lost() const {
  return std::ranges::all_of(kept_, [](const Kept& kept) { return kept.steps == 0; });
}

std::size_t StagedMargin::Stages::least_steps() const {
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (const Stage& stage : stages_) least = std::min(least, static_cast<std::size_t>(stage.steps));
  return least;
}

std::size_t StagedMargin::least_steps() const {
  const std::size_t least = std::min(stages_.least_steps(), certified_stages_.least_steps());
  return has_verifier_ ? std::min<std::size_t>(least, first_views_to_be_sure) : least;
}

Verdict StagedMargin::localized(const StepResult& step, double margin) const {
  return {.kind = VerdictKind::localized,
          .map_from_robot = step.hypotheses.front().map_from_robot,
          .why = fmt::format("better by {:.2f} than any other pose, and the best in {} steps over {:.1f} m",
                             margin, steps_, distance_)};
}

Verdict StagedMargin::undecided(const StepResult& step, double margin) const {
  if (std::optional<Verdict> verdict = ambiguous(candidates(step))) return *std::move(verdict);
  return {
      .kind = VerdictKind::searching,
      .why = fmt::format("the best pose is better by {:.2f} only, and the best in {} steps", margin, steps_)};
}

/// Poses below Omega_max are not among the hypotheses: without a rival there, the best one may still have it.
double StagedMargin::margin_of(const StepResult& step) const {
  const Hypothesis& best = step.hypotheses.front();
  const auto rival = std::ranges::find_if(step.hypotheses, [&](const Hypothesis& h) {
    return !near.are_near(h.map_from_robot, best.map_from_robot);
  });
  return best.score - (rival == step.hypotheses.end() ? step.omega_max : rival->score);
}

/// The best pose and its rivals of about the same score, each a rival of the others.
std::vector<Pose3> StagedMargin::candidates(const StepResult& step) const {
  std::vector<Pose3> poses;
  for (const Hypothesis& h : step.hypotheses) {
    if (h.score < step.hypotheses.front().score - candidate_margin) break;
    const bool repeats = std::ranges::any_of(
        poses, [&](const Pose3& other) { return near.are_near(h.map_from_robot, other); });
    if (!repeats) poses.push_back(h.map_from_robot);
  }
  return poses;
}

}  // namespace glocal::raters
