#include "glocal/localizer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "glocal/error.hpp"
#include "pipeline/in_stage.hpp"
#include "pipeline/stage_contracts.hpp"

namespace glocal {
namespace {

/// Names of the random streams within a step.
enum Stage : std::uint64_t { matching, clustering };

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

/// Takes all poses of a step from places relative to the map's origin to the map's frame.
void add_origin(StepResult& result, const Vector3& origin) {
  const auto add_to = [&](Pose3& pose) { pose = shifted(pose, origin); };
  const auto add_to_both = [&](Hypothesis& h) {
    add_to(h.map_from_local);
    add_to(h.map_from_robot);
  };
  for (Hypothesis& h : result.hypotheses) add_to_both(h);
  for (Cluster& cluster : result.clusters) add_to(cluster.map_from_robot);
  Verdict& verdict = result.verdict;
  if (verdict.map_from_robot) add_to(*verdict.map_from_robot);
  for (Pose3& candidate : verdict.candidates) add_to(candidate);
  if (verdict.estimate) add_to(verdict.estimate->map_from_robot);
  if (!result.verification) return;
  for (Hypothesis& rival : result.verification->rivals) add_to_both(rival);
}

/// Says what the verdict leaves out of account.
void add_prior(Verdict& verdict, const Prior& prior) {
  verdict.why +=
      fmt::format("{}only {} were looked at{}", verdict.why.empty() ? "" : "; ", to_string(prior),
                  verdict.kind == VerdictKind::unknown_place ? ": the robot is perhaps outside" : "");
}

double count_of(HitKind kind, const std::vector<HitKind>& hits) {
  return static_cast<double>(std::count(hits.begin(), hits.end(), kind));
}

/// Of those of which the map can tell.
std::optional<double> share_on_map(const std::vector<HitKind>& hits) {
  const double known = static_cast<double>(hits.size()) - count_of(HitKind::unknown, hits);
  return known == 0.0 ? std::nullopt : std::optional(count_of(HitKind::on_map, hits) / known);
}

/// Where nothing is declared, and the scan does not fit well: how it differs from the map.
void add_misfit(StepResult& result) {
  constexpr double worth_telling = 0.15;
  const auto all = static_cast<double>(result.hit_kinds.size());
  const double unmapped = count_of(HitKind::unmapped, result.hit_kinds);
  const double beyond = count_of(HitKind::beyond, result.hit_kinds);
  if (result.verdict.kind == VerdictKind::localized || unmapped + beyond <= worth_telling * all) return;
  result.verdict.why +=
      fmt::format("{}the map lacks {:.0f} % of the last scan, and {:.0f} % went through what it shows",
                  result.verdict.why.empty() ? "" : "; ", 100.0 * unmapped / all, 100.0 * beyond / all);
}

}  // namespace

std::string text_of(const RunningStage& stage, const char* what) {
  const bool in_step = stage.step != RunningStage::before_first;
  return fmt::format("{} '{}' {} {}", stage.kind, stage.name, what,
                     in_step ? fmt::format("in step {}", stage.step) : "while it was reset");
}

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
      origin_(setup.map->origin()),
      prior_(config.prior),
      unknown_place_(config.unknown_place, setup.map, contact_epsilon_on(*setup.map, config)),
      seed_(seed),
      rng_(seed_.stream({0})) {
  if (const auto why = why_nowhere(prior_, *setup.map))
    throw ConfigError({{"", 0, 0, "localizer.prior.region: " + *why}});
  if (motion_ == Motion::planar) origin_.z() = 0.0;
  if (config.setup_check.enabled && motion_ == Motion::planar) setup_.emplace(config.setup_check);
  setup.contact_epsilon = contact_epsilon_on(*setup.map, config);
  setup.motion = motion_;
  const auto make = [&](const auto& registry, const StrategyChoice& choice, RunningStage& stage) {
    if (const auto why = why_unfit(choice, registry, motion_)) throw ConfigError({{"", 0, 0, *why}});
    stage = {.kind = registry.kind(), .name = choice.name};
    const StageScope scope(&stage);
    return registry.make(choice, setup);
  };
  verifier_ = make(catalog.verifiers, config.verifier, stages_.verifier);
  setup.has_verifier = verifier_ != nullptr;
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

StepResult Localizer::step(const Observation& observation) {
  StepResult result;
  result.step = step_++;
  result.stamp = observation.stamp;
  result.motion = motion_;
  const LocalMap& local = add(observation, result);
  match(local, observation, result);
  result.omega_place = unknown_place_.update(local, result.hypotheses);
  if (!result.hypotheses.empty() && motion_ == Motion::planar) {
    result.hit_kinds =
        unknown_place_.kinds_of(observation.scan, seen_from_above(result.hypotheses.front().map_from_robot));
    result.omega_scan = share_on_map(result.hit_kinds);
  }
  cluster(result);
  rate(result);
  judge(result);
  check_setup(observation, local, result);
  verify(local, result);
  add_misfit(result);
  if (!gate_.is_open()) add_prior(result.verdict, prior_);
  if (!origin_.isZero(0.0)) add_origin(result, origin_);
  return result;
}

const LocalMap& Localizer::add(const Observation& observation, StepResult& result) {
  try {
    check_observation(observation, motion_);
  } catch (const BrokenContract& broken) {
    throw StrategyError(fmt::format("the observation of step {}: {}", result.step, broken.what()));
  }
  in_stage(stages_.local_mapper, result.step, [&] {
    timed(&StageTimes::local_map, result, [&] { local_mapper_->add(observation); });
    check_local_map(local_mapper_->map(), motion_);
  });
  const LocalMap& local = local_mapper_->map();
  result.local_from_robot = local.local_from_robot;
  result.local_map_epoch = local.epoch;
  result.local_map_points = local.points.size();
  if (prior_.is_given()) {
    start_.follow(local, observation.odom_from_robot);
    gate_ = PoseGate(shifted(prior_, -origin_), start_.local_from_start());
  }
  return local;
}

void Localizer::match(const LocalMap& local, const Observation& latest, StepResult& result) {
  in_stage(stages_.threshold_policy, result.step, [&] {
    result.omega_max = threshold_policy_->omega_max();
    check_threshold(result.omega_max);
  });
  in_stage(stages_.matcher, result.step, [&] {
    Rng rng = rng_.stream({result.step, matching});
    MatchResult match;
    timed(&StageTimes::match, result, [&] {
      match = matcher_->match({local, latest, result.omega_max, gate_}, rng);
    });
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
}

void Localizer::cluster(StepResult& result) {
  in_stage(stages_.clusterer, result.step, [&] {
    Rng rng = rng_.stream({result.step, clustering});
    timed(&StageTimes::cluster, result,
          [&] { result.clusters = clusterer_->cluster(result.hypotheses, rng); });
    check_clusters(result.clusters, result.hypotheses.size(), motion_);
  });
}

void Localizer::rate(StepResult& result) {
  in_stage(stages_.rater, result.step, [&] {
    timed(&StageTimes::rate, result,
          [&] { result.ratings = rater_->rate(result.clusters, result.hypotheses); });
    check_ratings(result.ratings, result.clusters.size());
  });
  sort_by_rating(result.clusters, result.ratings);
}

void Localizer::judge(StepResult& result) {
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
}

void Localizer::check_setup(const Observation& observation, const LocalMap& local, StepResult& result) {
  if (!setup_) return;
  result.setup = setup_->update(observation, local);
  const bool is_localized = result.verdict.kind == VerdictKind::localized;
  if (!result.setup->fault && !(result.setup->is_in_doubt && is_localized)) return;
  result.verdict.kind = VerdictKind::searching;
  result.verdict.map_from_robot.reset();
  result.verdict.candidates.clear();
  result.verdict.why = result.setup->fault ? result.setup->why()
                                           : "the best pose is not declared as long as scans and odometry do "
                                             "not tell the same motion clearly enough";
}

void Localizer::reset(std::uint64_t trial) {
  trial_ = trial;
  rng_ = seed_.stream({trial});
  step_ = 0;
  unknown_place_.reset();
  if (setup_) setup_->reset();
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
