#include "glocal/localizer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

#include "glocal/error.hpp"
#include "glocal/extent.hpp"
#include "pipeline/in_stage.hpp"
#include "pipeline/stage_contracts.hpp"

namespace glocal {
namespace {

/// Names of the random streams within a step.
enum Stage : std::uint64_t { matching, clustering };

/// Fewer tell no pose: three numbers in the plane; in space it takes several to tell a surface.
std::size_t least_hits(Motion motion) {
  return motion == Motion::planar ? 5 : 30;
}

/// The height that all points of a map have, m; none if they differ.
std::optional<float> height_of(const Points& points) {
  const Extent z = extent_of(points.z);
  return z.low == z.high ? std::optional(z.low) : std::nullopt;
}

/// The observation with its hits at this height; none if they are there already. On a flat map heights say
/// nothing: contact would miss what a laser sees that is mounted higher than the map.
std::optional<Observation> flattened(const Observation& observation, float height) {
  const auto is_there = [&](float z) { return z == height || !std::isfinite(z); };
  const Scan& scan = observation.scan;
  if (std::ranges::all_of(scan.hits.z, is_there) && std::ranges::all_of(scan.free_ends.z, is_there))
    return std::nullopt;
  Observation flat = observation;
  for (std::vector<float>* heights : {&flat.scan.hits.z, &flat.scan.free_ends.z})
    std::ranges::replace_if(
        *heights, [&](float z) { return !is_there(z); }, height);
  flat.scan.origin.z = height;
  return flat;
}

/// Clusters and their ratings, best first; equal ones keep their order.
void sort_by_rating(std::vector<Cluster>& clusters, std::vector<Rating>& ratings) {
  std::vector<std::size_t> order(clusters.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater<>(), [&](std::size_t i) { return ratings[i].r; });
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
  if (result.expected) add_to(result.expected->map_from_robot);
  if (!result.verification) return;
  for (Hypothesis& rival : result.verification->rivals) add_to_both(rival);
}

void note_best(StepResult& result) {
  if (result.hypotheses.empty()) return;
  result.omega_best = result.hypotheses.front().quality;
  result.score_best = result.hypotheses.front().score;
}

/// Says what the verdict leaves out of account.
void add_prior(Verdict& verdict, const Prior& prior) {
  verdict.why +=
      fmt::format("{}only {} were looked at{}", verdict.why.empty() ? "" : "; ", to_string(prior),
                  verdict.kind == VerdictKind::unknown_place ? ": the robot is perhaps outside" : "");
}

/// Until a search that goes on has come to its end.
void put_off(Verdict& verdict) {
  verdict.kind = VerdictKind::searching;
  verdict.map_from_robot.reset();
  verdict.why = "the best pose is not declared yet: the search of the whole map goes on";
}

/// By how much a distance that counts as contact must be larger, in halves, so that most hits of scans with
/// this noise (m) are within it.
double epsilon_factor(double range_noise, double epsilon) {
  constexpr double deviations = 1.25;
  constexpr double largest = 2.0;
  return std::clamp(std::ceil(2.0 * deviations * range_noise / epsilon) / 2.0, 1.0, largest);
}

double count_of(HitKind kind, const std::vector<HitKind>& hits) {
  return static_cast<double>(std::ranges::count(hits, kind));
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
    : config_(config),
      catalog_(catalog),
      stage_setup_(std::move(setup)),
      motion_(config.motion),
      origin_(stage_setup_.map->origin()),
      seed_(seed),
      rng_(seed_.stream({0})) {
  if (const auto why = why_nowhere(config_.prior, *stage_setup_.map))
    throw ConfigError("", "localizer.prior.region: " + *why);
  if (motion_ == Motion::planar) {
    origin_.z() = 0.0;
    flat_at_ = height_of(stage_setup_.map->points());
  }
  if (config.setup_check.enabled && motion_ == Motion::planar) setup_.emplace(config.setup_check);
  stage_setup_.motion = motion_;
  if (config.looks_per_step > 0)
    stage_setup_.looks_per_step = static_cast<std::size_t>(config.looks_per_step);
  use_epsilon(contact_epsilon_on(*stage_setup_.map, config));
  local_mapper_ = make(catalog.local_mappers, config.local_mapper, stages_.local_mapper);
  clusterer_ = make(catalog.clusterers, config.clusterer, stages_.clusterer);
  rater_ = make(catalog.raters, config.rater, stages_.rater);
  threshold_policy_ = make(catalog.threshold_policies, config.threshold_policy, stages_.threshold_policy);
  verdict_rule_ = make(catalog.verdict_rules, config.verdict_rule, stages_.verdict_rule);
  // What is made later reads the same files again.
  stage_setup_.note_input = [](const std::filesystem::path&) {};
}

template <class Strategy>
std::unique_ptr<Strategy> Localizer::make(const Registry<Strategy, StageSetup>& registry,
                                          const StrategyChoice& choice, RunningStage& stage) const {
  if (const auto why = why_unfit(choice, registry, motion_)) throw ConfigError("", *why);
  stage.kind = registry.kind();
  stage.name = choice.name;
  const StageScope scope(&stage);
  return registry.make(choice, stage_setup_);
}

void Localizer::use_epsilon(double epsilon) {
  stage_setup_.contact_epsilon = epsilon;
  auto found = by_epsilon_.find(epsilon);
  if (found == by_epsilon_.end()) {
    // Matchers first: while some of their indexes are made, these take more memory than in the end.
    auto matcher = make(catalog_.matchers, config_.matcher, stages_.matcher);
    auto verifier = make(catalog_.verifiers, config_.verifier, stages_.verifier);
    stage_setup_.has_verifier = verifier != nullptr;
    UnknownPlaceMonitor unknown_place(config_.unknown_place, stage_setup_.map, epsilon);
    found = by_epsilon_
                .emplace(epsilon,
                         ContactStages{std::move(verifier), std::move(matcher), std::move(unknown_place)})
                .first;
  }
  by_contact_ = &found->second;
}

void Localizer::use(std::unique_ptr<ThresholdPolicy> threshold_policy) {
  threshold_policy_ = std::move(threshold_policy);
}

StepResult Localizer::step(const Observation& observation) {
  if (flat_at_) {
    if (const auto flat = flattened(observation, *flat_at_)) return step(*flat);
  }
  if (auto last = std::exchange(open_, std::nullopt); last && last->is_matching) {
    last->is_matching = false;
    static_cast<void>(judged(local_mapper_->map(), open_observation_, *std::move(last), 0));
    open_.reset();
  }
  StepResult result;
  result.step = step_++;
  result.stamp = observation.stamp;
  result.motion = motion_;
  result.saw_nothing = observation.scan.hits.size() < least_hits(motion_);
  const LocalMap& local = add(observation, result);
  follow_noise(observation.scan, result);
  match(local, observation, result);
  return judged(local, observation, std::move(result));
}

StepResult Localizer::go_on(std::size_t looks) {
  if (!open_) throw std::logic_error("no search is open that could go on");
  StepResult result = *std::exchange(open_, std::nullopt);
  const LocalMap& local = local_mapper_->map();
  if (!result.is_matching) return ended(local, std::move(result), looks);
  in_stage(stages_.matcher, result.step, [&] {
    MatchResult match;
    timed(&StageTimes::after, result, [&] { match = by_contact_->matcher->go_on(local, looks); });
    take_in(std::move(match), result);
  });
  const Observation latest = std::move(open_observation_);
  return judged(local, latest, std::move(result), looks);
}

StepResult Localizer::judged(const LocalMap& local, const Observation& latest, StepResult result,
                             std::optional<std::size_t> looks_after) {
  for (Hypothesis& h : result.hypotheses) h.map_from_robot = h.map_from_local * local.local_from_robot;
  note_best(result);
  if (!result.is_matching) {
    in_stage(stages_.threshold_policy, result.step, [&] { threshold_policy_->update(result.hypotheses); });
    follow_expected(local, result);
    result.omega_place = by_contact_->unknown_place.update(local, latest.scan.hits, result.hypotheses);
    if (!result.hypotheses.empty() && motion_ == Motion::planar) {
      result.hit_kinds = by_contact_->unknown_place.kinds_of(
          latest.scan, seen_from_above(result.hypotheses.front().map_from_robot));
      result.omega_scan = share_on_map(result.hit_kinds);
    }
    cluster(result);
    rate(result);
    judge(result);
    check_setup(latest, local, result);
  }
  StepResult answer = ended(local, std::move(result), looks_after);
  if (open_) open_observation_ = latest;
  return answer;
}

StepResult Localizer::ended(const LocalMap& local, StepResult result,
                            std::optional<std::size_t> looks_after) {
  if (!result.is_matching) verify(local, result, looks_after);
  if (result.goes_on()) {
    open_ = result;
    put_off(result.verdict);
  }
  add_misfit(result);
  if (!gate_.is_open()) add_prior(result.verdict, config_.prior);
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
  if (config_.prior.is_given()) {
    start_.follow(local, observation.odom_from_robot);
    gate_ = PoseGate(shifted(config_.prior, -origin_), start_.local_from_start());
  }
  return local;
}

void Localizer::follow_noise(const Scan& scan, StepResult& result) {
  if (motion_ == Motion::planar) {
    noise_.take_in(scan);
    result.range_noise = noise_.deviation();
  }
  const double least = by_epsilon_.begin()->first;
  const double epsilon =
      config_.contact_epsilon ? least : least * epsilon_factor(result.range_noise.value_or(0.0), least);
  if (epsilon > stage_setup_.contact_epsilon) {
    in_stage(stages_.matcher, result.step, [&] { use_epsilon(epsilon); });
    forget_poses(result.step);
  }
  result.contact_epsilon = stage_setup_.contact_epsilon;
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
      match = by_contact_->matcher->match({local, latest, result.omega_max, gate_}, rng);
    });
    take_in(std::move(match), result);
  });
}

void Localizer::take_in(MatchResult match, StepResult& result) const {
  check_hypotheses(match.hypotheses, result.omega_max, motion_);
  result.hypotheses = std::move(match.hypotheses);
  std::erase_if(result.hypotheses, [&](const Hypothesis& h) { return !gate_.allows(h.map_from_local); });
  result.is_matching = match.goes_on;
  result.proposals = match.proposals;
  result.points_tested = match.points_tested;
}

void Localizer::follow_expected(const LocalMap& local, StepResult& result) {
  if (!expected_) return;
  if (result.step == 0) {
    expected_map_from_local_ = shifted(expected_->map_from_robot, -origin_) * inverse(local.local_from_robot);
    expected_epoch_ = local.epoch;
    is_expected_scored_ = false;
  }
  if (local.epoch != expected_epoch_) return expected_.reset();
  if (local.points.empty()) return;
  if (!std::exchange(is_expected_scored_, true)) add_expected(local, result);
  const Pose3 map_from_robot = expected_map_from_local_ * local.local_from_robot;
  constexpr PoseTolerance near;
  const bool is_best =
      !result.hypotheses.empty() && near.are_near(result.hypotheses.front().map_from_robot, map_from_robot);
  if (!is_best) return expected_.reset();
  result.expected = {map_from_robot, expected_->odds};
}

void Localizer::add_expected(const LocalMap& local, StepResult& result) {
  std::vector<Hypothesis>& hypotheses = result.hypotheses;
  const auto contact = contact_index(*stage_setup_.map, "bitset", stage_setup_.contact_epsilon)
                           ->share(local.points, expected_map_from_local_);
  in_stage(stages_.matcher, result.step, [&] {
    timed(&StageTimes::match, result, [&] {
      for (Hypothesis& h :
           by_contact_->matcher->rescore({Hypothesis::by_contact(expected_map_from_local_, contact)}, local))
        hypotheses.push_back(h);
    });
    for (Hypothesis& h : hypotheses) h.map_from_robot = h.map_from_local * local.local_from_robot;
    std::ranges::stable_sort(hypotheses, std::greater<>(), &Hypothesis::score);
    std::erase_if(hypotheses, [&](const Hypothesis& h) {
      return h.score < result.omega_max || !gate_.allows(h.map_from_local);
    });
    check_hypotheses(hypotheses, result.omega_max, motion_);
  });
  note_best(result);
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
  if (by_contact_->unknown_place.is_unknown(result.omega_place)) {
    withhold(result);
    result.verdict = {
        .kind = VerdictKind::unknown_place,
        .why = fmt::format("only {:.0f} % of what was last seen is on the map", 100.0 * *result.omega_place)};
  }
}

void Localizer::withhold(const StepResult& result) {
  if (result.verdict.kind == VerdictKind::localized)
    in_stage(stages_.verdict_rule, result.step, [&] { verdict_rule_->withhold(); });
}

void Localizer::check_setup(const Observation& observation, const LocalMap& local, StepResult& result) {
  if (!setup_) return;
  result.setup = setup_->update(observation, local);
  const bool is_localized = result.verdict.kind == VerdictKind::localized;
  if (!result.setup->fault && !(result.setup->is_in_doubt && is_localized)) return;
  withhold(result);
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
  open_.reset();
  expected_.reset();
  if (setup_) setup_->reset();
  start_.reset();
  noise_ = {};
  use_epsilon(by_epsilon_.begin()->first);
  in_stage(stages_.local_mapper, RunningStage::before_first, [&] { local_mapper_->reset(); });
  forget_poses(RunningStage::before_first);
}

void Localizer::forget_poses(std::size_t step) {
  by_contact_->unknown_place.reset();
  verified_.reset();
  forget_verification(step);
  in_stage(stages_.matcher, step, [&] { by_contact_->matcher->reset(); });
  in_stage(stages_.threshold_policy, step, [&] { threshold_policy_->reset(); });
  in_stage(stages_.verdict_rule, step, [&] { verdict_rule_->reset(); });
}

}  // namespace glocal
