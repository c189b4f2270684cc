#include "glocal/localizer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "cpu_time.hpp"
#include "glocal/error.hpp"
#include "pipeline/stage_contracts.hpp"

namespace glocal {
namespace {

/// Names of the random streams within a step.
enum Stage : std::uint64_t { matching, clustering };

/// Does a stage's work, and adds how long it took.
template <class Work>
void timed(double StageTimes::*stage, StepResult& result, Work work) {
  const auto start = std::chrono::steady_clock::now();
  const std::int64_t cpu_start = cpu_time_ns();
  work();
  result.stage_cpu_ms.*stage += 1e-6 * static_cast<double>(cpu_time_ns() - cpu_start);
  result.stage_ms.*stage +=
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

/// "matcher 'ransam'", and what has happened there: "breaks its contract in step 3".
std::string text_of(const RunningStage& stage, const char* what) {
  const bool in_step = stage.step != RunningStage::before_first;
  return fmt::format("{} '{}' {} {}", stage.kind, stage.name, what,
                     in_step ? fmt::format("in step {}", stage.step) : "while it was reset");
}

/// Clusters and their ratings, best first; equal ones keep their order.
void sort_by_rating(std::vector<Cluster>& clusters, std::vector<Rating>& ratings) {
  std::vector<std::size_t> order(clusters.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return ratings[a].r > ratings[b].r; });
  std::vector<Cluster> sorted_clusters;
  std::vector<Rating> sorted_ratings;
  for (const std::size_t i : order) {
    sorted_clusters.push_back(std::move(clusters[i]));
    sorted_ratings.push_back(ratings[i]);
  }
  clusters = std::move(sorted_clusters);
  ratings = std::move(sorted_ratings);
}

/// Says what the verdict leaves out of account.
void add_prior(Verdict& verdict, const Prior& prior) {
  verdict.why +=
      fmt::format("{}only {} were looked at{}", verdict.why.empty() ? "" : "; ", to_string(prior),
                  verdict.kind == VerdictKind::unknown_place ? ": the robot is perhaps outside" : "");
}

/// Whether a hypothesis is no rival of a pose.
bool is_near(const Hypothesis& h, const Pose3& map_from_robot, const Verification& v) {
  return distance(h.map_from_robot, map_from_robot) <= v.distance &&
         rotation_between(h.map_from_robot, map_from_robot) <= v.rotation;
}

/// The best score of a hypothesis that is no rival of this pose.
double score_near(const Pose3& map_from_robot, const StepResult& result) {
  for (const Hypothesis& h : result.hypotheses) {
    if (is_near(h, map_from_robot, *result.verification)) return h.score;
  }
  return result.score_best;
}

/// Takes the verdict back where a rival is about as good, or the search was given up; else tells the
/// certificate.
void judge_by(Verification& v, Verdict& verdict) {
  std::vector<Pose3> candidates = {*verdict.map_from_robot};
  for (const Hypothesis& rival : v.rivals) {
    if (v.is_about_as_good(rival)) candidates.push_back(rival.map_from_robot);
  }
  const std::size_t rivals = candidates.size() - 1;
  const bool is_topped = v.certificate && v.certificate->at_most > v.certificate->contact;
  v.is_refuted = rivals > 0 || !v.certificate || (verdict.needs_certificate && is_topped);
  if (!v.is_refuted) {
    verdict.why += fmt::format("; {:.0f} % contact, and at most {:.0f} % at any pose elsewhere",
                               100.0 * v.certificate->contact, 100.0 * v.certificate->at_most);
    return;
  }
  verdict.kind = rivals > 0 ? VerdictKind::ambiguous : VerdictKind::searching;
  verdict.map_from_robot.reset();
  verdict.why = "the best pose was about to be declared, but ";
  if (rivals > 0) {
    verdict.why += fmt::format("a search of the whole map found {} about as good",
                               rivals == 1 ? "another one" : fmt::format("{} others", rivals));
  } else if (is_topped) {
    verdict.why += fmt::format("it has {:.0f} % contact, and up to {:.0f} % cannot be ruled out elsewhere",
                               100.0 * v.certificate->contact, 100.0 * v.certificate->at_most);
  } else {
    verdict.why += "the search of the whole map was given up: too many poses are about as good";
  }
  if (verdict.estimate)
    verdict.estimate->confidence =
        std::min(verdict.estimate->confidence, 1.0 / static_cast<double>(rivals + 1));
  if (rivals > 0) verdict.candidates = std::move(candidates);
}

}  // namespace

double contact_epsilon_on(const GlobalMap& map, const LocalizerConfig& config) {
  const double resolution = map.resolution();
  return config.contact_epsilon.value_or(resolution > 0.0 ? 2.0 * resolution : StageSetup{}.contact_epsilon);
}

std::optional<std::string> why_unfit(const StrategyChoice& choice, const RegistryBase& registry,
                                     Motion motion) {
  const StrategyInfo* info = registry.find(choice.name);
  if (info == nullptr || info->motions.contain(motion)) return std::nullopt;
  std::vector<std::string> fit;
  const StrategyInfo* counterpart = registry.counterpart(info->name);
  const bool has_like = counterpart != nullptr && counterpart->motions.contain(motion);
  for (const StrategyInfo* other : registry.all()) {
    if (has_like ? other == counterpart : other->motions.contain(motion)) fit.push_back(other->name);
  }
  const std::string others = fit.empty()
                                 ? fmt::format("; no {} can do {}", registry.kind(), to_string(motion))
                                 : fmt::format(", or take {}", fmt::join(fit, " or "));
  const std::string able = to_string(info->motions);
  return fmt::format("the {} '{}' can do the motion {}, not {}; set localizer.motion to {}{}",
                     registry.kind(), info->name, able, to_string(motion), able, others);
}

Localizer::Localizer(const LocalizerConfig& config, const Catalog& catalog, StageSetup setup,
                     std::uint64_t seed)
    : motion_(config.motion),
      prior_(config.prior),
      unknown_place_(config.unknown_place, setup.map, contact_epsilon_on(*setup.map, config)),
      seed_(seed),
      rng_(seed_.stream({0})) {
  if (const auto why = why_nowhere(prior_, *setup.map))
    throw ConfigError({{"", 0, 0, "localizer.prior.region: " + *why}});
  setup.contact_epsilon = contact_epsilon_on(*setup.map, config);
  setup.motion = motion_;
  const auto make = [&](const auto& registry, const StrategyChoice& choice, RunningStage& stage) {
    if (const auto why = why_unfit(choice, registry, motion_)) throw ConfigError({{"", 0, 0, *why}});
    stage = {.kind = registry.kind(), .name = choice.name};
    const StageScope scope(&stage);
    return registry.make(choice, setup);
  };
  verifier_ = make(catalog.verifiers, config.verifier, stages_.verifier);
  setup.has_verifier = verifier_->verifies();
  local_mapper_ = make(catalog.local_mappers, config.local_mapper, stages_.local_mapper);
  matcher_ = make(catalog.matchers, config.matcher, stages_.matcher);
  clusterer_ = make(catalog.clusterers, config.clusterer, stages_.clusterer);
  rater_ = make(catalog.raters, config.rater, stages_.rater);
  threshold_policy_ = make(catalog.threshold_policies, config.threshold_policy, stages_.threshold_policy);
  verdict_rule_ = make(catalog.verdict_rules, config.verdict_rule, stages_.verdict_rule);
}

void Localizer::use(std::unique_ptr<ThresholdPolicy> threshold_policy) {
  threshold_policy_ = std::move(threshold_policy);
}

template <class Work>
void Localizer::in_stage(RunningStage& stage, std::size_t step, Work work) const {
  stage.trial = trial_;
  stage.step = step;
  const StageScope scope(&stage);
  try {
    work();
  } catch (const BrokenContract& broken) {
    throw StrategyError(fmt::format("{}: {}", text_of(stage, "breaks its contract"), broken.what()));
  } catch (const std::exception& error) {
    throw StrategyError(fmt::format("{}: {}", text_of(stage, "threw an exception"), error.what()));
  } catch (...) {
    throw StrategyError(text_of(stage, "threw something that is no std::exception"));
  }
}

StepResult Localizer::step(const Observation& observation) {
  StepResult result;
  result.step = step_++;
  result.stamp = observation.stamp;
  result.motion = motion_;

  try {
    check_observation(observation, motion_);
  } catch (const BrokenContract& broken) {
    throw StrategyError(fmt::format("the observation of step {}: {}", result.step, broken.what()));
  }

  const LocalMap* added = nullptr;
  in_stage(stages_.local_mapper, result.step, [&] {
    timed(&StageTimes::local_map, result, [&] {
      local_mapper_->add(observation);
      added = &local_mapper_->map();
    });
    check_local_map(*added, motion_);
  });
  const LocalMap& local = *added;
  result.local_from_robot = local.local_from_robot;
  result.local_map_epoch = local.epoch;
  result.local_map_points = local.points.size();
  if (prior_.is_given()) {
    start_.follow(local, observation.odom_from_robot);
    gate_ = PoseGate(prior_, start_.local_from_start());
  }

  in_stage(stages_.threshold_policy, result.step, [&] {
    result.omega_max = threshold_policy_->omega_max();
    check_threshold(result.omega_max);
  });
  in_stage(stages_.matcher, result.step, [&] {
    Rng rng = rng_.stream({result.step, matching});
    MatchResult match;
    if (!gate_.is_open()) matcher_->restrict_to(gate_);
    timed(&StageTimes::match, result,
          [&] { match = matcher_->match(local, observation, result.omega_max, rng); });
    check_match(match, result.omega_max, motion_);
    result.hypotheses = std::move(match.hypotheses);
    std::erase_if(result.hypotheses, [&](const Hypothesis& h) { return !gate_.allows(h.map_from_local); });
    result.proposals = match.proposals;
    result.points_tested = match.points_tested;
  });
  for (Hypothesis& h : result.hypotheses) h.map_from_robot = h.map_from_local * local.local_from_robot;
  if (!result.hypotheses.empty()) {
    result.omega_best = result.hypotheses.front().quality;
    result.score_best = result.hypotheses.front().score;
  }
  in_stage(stages_.threshold_policy, result.step, [&] { threshold_policy_->update(result.hypotheses); });
  result.omega_place = unknown_place_.update(local, result.hypotheses);
  if (!result.hypotheses.empty() && motion_ == Motion::planar)
    result.omega_scan = unknown_place_.share_of(observation.scan.hits,
                                                seen_from_above(result.hypotheses.front().map_from_robot));

  in_stage(stages_.clusterer, result.step, [&] {
    Rng rng = rng_.stream({result.step, clustering});
    timed(&StageTimes::cluster, result,
          [&] { result.clusters = clusterer_->cluster(result.hypotheses, rng); });
    check_clusters(result.clusters, result.hypotheses.size(), motion_);
  });
  in_stage(stages_.rater, result.step, [&] {
    timed(&StageTimes::rate, result,
          [&] { result.ratings = rater_->rate(result.clusters, result.hypotheses); });
    check_ratings(result.ratings, result.clusters.size());
  });
  sort_by_rating(result.clusters, result.ratings);

  in_stage(stages_.verdict_rule, result.step, [&] {
    result.verdict = verdict_rule_->judge(result);
    check_verdict(result.verdict, motion_);
  });
  if (unknown_place_.is_unknown(result.omega_place)) {
    result.verdict = {
        VerdictKind::unknown_place,
        std::nullopt,
        {},
        fmt::format("only {:.0f} % of what was last seen is on the map", 100.0 * *result.omega_place)};
  }
  verify(result, local);
  if (!gate_.is_open()) add_prior(result.verdict, prior_);
  return result;
}

void Localizer::verify(StepResult& result, const LocalMap& local) {
  if (result.verdict.kind != VerdictKind::localized) is_verified_ = false;
  if (result.verdict.kind != VerdictKind::localized || is_verified_ || local.points.empty() ||
      !verifier_->verifies())
    return;
  const Pose3 declared = *result.verdict.map_from_robot;
  std::optional<Verification>& verification = result.verification;
  in_stage(stages_.verifier, result.step, [&] {
    timed(&StageTimes::verify, result, [&] {
      verification = verifier_->verify(local, declared * inverse(local.local_from_robot), gate_);
    });
    check_verification(*verification, motion_);
  });
  is_verified_ = true;
  in_stage(stages_.matcher, result.step, [&] {
    timed(&StageTimes::verify, result,
          [&] { verification->rivals = matcher_->take_up(std::move(verification->rivals), local); });
    for (Hypothesis& h : verification->rivals) h.map_from_robot = h.map_from_local * local.local_from_robot;
    check_hypotheses(verification->rivals, 0.0, motion_);
  });
  // A matcher that refines what it takes up may have come back to the declared pose.
  std::erase_if(verification->rivals,
                [&](const Hypothesis& h) { return is_near(h, declared, *verification); });
  verification->score = score_near(declared, result);
  judge_by(*verification, result.verdict);
  if (!verification->is_refuted) return;
  is_verified_ = false;
  in_stage(stages_.verdict_rule, result.step, [&] { verdict_rule_->refute(*verification); });
}

void Localizer::reset(std::uint64_t trial) {
  trial_ = trial;
  rng_ = seed_.stream({trial});
  step_ = 0;
  unknown_place_.reset();
  start_.reset();
  is_verified_ = false;
  const auto reset = [&](RunningStage& stage, auto& strategy) {
    in_stage(stage, RunningStage::before_first, [&] { strategy->reset(); });
  };
  reset(stages_.local_mapper, local_mapper_);
  reset(stages_.matcher, matcher_);
  reset(stages_.threshold_policy, threshold_policy_);
  reset(stages_.verdict_rule, verdict_rule_);
}

}  // namespace glocal
