// Clustering 10 to 100,000 hypotheses, and merging a flood of them beforehand.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <vector>

#include "bench/scenes.hpp"
#include "clustering/dbscan.hpp"
#include "clustering/hierarchical_kmeans.hpp"
#include "clustering/mean_shift.hpp"
#include "clustering/pose_grid.hpp"
#include "matchers/common/merge.hpp"

namespace glocal::bench {
namespace {

/// Hypotheses around so many poses all over a map of 26 m x 27 m, 3 cm and 2 degrees apart.
std::vector<Hypothesis> around(std::size_t poses, std::size_t hypotheses) {
  Rng rng(1);
  std::vector<Pose2> centres;
  for (std::size_t i = 0; i < poses; ++i) {
    centres.push_back({rng.uniform(0.0, 26.0), rng.uniform(0.0, 27.0), rng.uniform(-3.1, 3.1)});
  }
  std::vector<Hypothesis> result;
  for (std::size_t i = 0; i < hypotheses; ++i) {
    const Pose2& centre = centres[i % poses];
    const Pose2 pose{centre.x + rng.normal(0.03), centre.y + rng.normal(0.03),
                     wrap_angle(centre.theta + rng.normal(radians(2.0)))};
    result.push_back({.map_from_local = pose, .map_from_robot = pose, .score = rng.uniform(0.6, 1.0)});
  }
  std::ranges::stable_sort(result, std::greater<>(), &Hypothesis::score);
  return result;
}

/// Arguments: hypotheses, and around how many poses they lie (at most one pose each).
template <class Strategy>
void cluster(benchmark::State& state) {
  const auto n = static_cast<std::size_t>(state.range(0));
  const std::vector<Hypothesis> hypotheses = around(std::min(n, static_cast<std::size_t>(state.range(1))), n);
  Strategy strategy({});
  std::size_t clusters = 0;
  for ([[maybe_unused]] auto _ : state) {
    Rng rng(1);
    clusters = strategy.cluster(hypotheses, rng).size();
  }
  state.counters["clusters"] = static_cast<double>(clusters);
  state.counters["per_hypothesis"] = time_per_item(static_cast<double>(n));
}

/// Argument: the most hypotheses that are left of 20,000. The clock stands while the copy is made that a
/// merge uses up: to stop it takes about a microsecond, a merge some milliseconds.
void merge(benchmark::State& state) {
  const std::vector<Hypothesis> flood = around(1000, 20'000);
  std::size_t left = 0;
  for ([[maybe_unused]] auto _ : state) {
    state.PauseTiming();
    std::vector<Hypothesis> hypotheses = flood;
    state.ResumeTiming();
    merge_hypotheses(hypotheses, {}, static_cast<std::size_t>(state.range(0)));
    left = hypotheses.size();
  }
  state.counters["left"] = static_cast<double>(left);
}

void many_hypotheses(benchmark::internal::Benchmark* timed) {
  timed->ArgsProduct({{1000, 10'000, 100'000}, {3, 1000, 100'000}})->ArgNames({"hypotheses", "poses"});
  timed->Unit(benchmark::kMillisecond);
}
BENCHMARK(reference_loop)->Unit(benchmark::kMillisecond);
BENCHMARK(cluster<clustering::HierarchicalKmeans>)
    ->ArgsProduct({{10, 100, 1000, 5000, 20'000}, {3, 1000}})
    ->ArgNames({"hypotheses", "poses"})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(cluster<clustering::Dbscan>)->Apply(many_hypotheses);
BENCHMARK(cluster<clustering::MeanShift>)->Apply(many_hypotheses);
BENCHMARK(cluster<clustering::PoseGridClusterer>)->Apply(many_hypotheses);
BENCHMARK(merge)->Arg(10'000)->Arg(2000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace glocal::bench

BENCHMARK_MAIN();
