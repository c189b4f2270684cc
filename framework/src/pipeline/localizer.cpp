#include "glocal/localizer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <numeric>
#include <utility>

namespace glocal {
namespace {

/// Names of the random streams within a step.
enum Stage : std::uint64_t { matching, clustering };

/// Runs one stage and notes how long it took, ms.
template <class Work>
auto timed(double& ms, Work work) {
  const auto start = std::chrono::steady_clock::now();
  auto result = work();
  ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return result;
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

}  // namespace

double contact_epsilon_on(const GlobalMap& map, const LocalizerConfig& config) {
  const double resolution = map.grid().resolution;
  return config.contact_epsilon.value_or(resolution > 0.0 ? 2.0 * resolution : StageSetup{}.contact_epsilon);
}

Localizer::Localizer(const LocalizerConfig& config, const Catalog& catalog, StageSetup setup,
                     std::uint64_t seed)
    : unknown_place_(config.unknown_place, *setup.map, contact_epsilon_on(*setup.map, config)),
      seed_(seed),
      trial_(seed_.stream({0})) {
  setup.contact_epsilon = contact_epsilon_on(*setup.map, config);
  local_mapper_ = catalog.local_mappers.make(config.local_mapper, setup);
  matcher_ = catalog.matchers.make(config.matcher, setup);
  clusterer_ = catalog.clusterers.make(config.clusterer, setup);
  rater_ = catalog.raters.make(config.rater, setup);
  threshold_policy_ = catalog.threshold_policies.make(config.threshold_policy, setup);
  verdict_rule_ = catalog.verdict_rules.make(config.verdict_rule, setup);
}

void Localizer::use(std::unique_ptr<ThresholdPolicy> threshold_policy) {
  threshold_policy_ = std::move(threshold_policy);
}

StepResult Localizer::step(const Observation& observation) {
  StepResult result;
  result.step = step_++;
  result.stamp = observation.stamp;

  const LocalMap& local = timed(result.stage_ms.local_map, [&]() -> std::reference_wrapper<const LocalMap> {
    local_mapper_->add(observation);
    return local_mapper_->map();
  });
  result.local_from_robot = local.local_from_robot;
  result.local_map_epoch = local.epoch;
  result.local_map_points = local.points.size();

  result.omega_max = threshold_policy_->omega_max();
  Rng matching_rng = trial_.stream({result.step, matching});
  MatchResult match = timed(result.stage_ms.match, [&] {
    return matcher_->match(local, observation, result.omega_max, matching_rng);
  });
  result.hypotheses = std::move(match.hypotheses);
  for (Hypothesis& h : result.hypotheses) h.map_from_robot = h.map_from_local * local.local_from_robot;
  result.proposals = match.proposals;
  result.points_tested = match.points_tested;
  if (!result.hypotheses.empty()) {
    result.omega_best = result.hypotheses.front().quality;
    result.score_best = result.hypotheses.front().score;
  }
  threshold_policy_->update(result.hypotheses);
  result.omega_place = unknown_place_.update(local, result.hypotheses);

  Rng clustering_rng = trial_.stream({result.step, clustering});
  result.clusters =
      timed(result.stage_ms.cluster, [&] { return clusterer_->cluster(result.hypotheses, clustering_rng); });
  result.ratings =
      timed(result.stage_ms.rate, [&] { return rater_->rate(result.clusters, result.hypotheses); });
  sort_by_rating(result.clusters, result.ratings);

  result.verdict = verdict_rule_->judge(result);
  if (unknown_place_.is_unknown(result.omega_place)) {
    result.verdict = {
        VerdictKind::unknown_place,
        std::nullopt,
        {},
        fmt::format("only {:.0f} % of what was last seen is on the map", 100.0 * *result.omega_place)};
  }
  return result;
}

void Localizer::reset(std::uint64_t trial) {
  local_mapper_->reset();
  matcher_->reset();
  threshold_policy_->reset();
  verdict_rule_->reset();
  unknown_place_.reset();
  trial_ = seed_.stream({trial});
  step_ = 0;
}

}  // namespace glocal
