// Calls of strategies in Python that do nothing. The file bench/python_calls.py has them; each time is one
// call through the interface of C++, from a thread that is new to Python for each call or has been there
// before.
#include <benchmark/benchmark.h>

#include <cstddef>
#include <memory>
#include <thread>
#include <vector>

#include "app/python_plugins.hpp"
#include "bench/scenes.hpp"
#include "glocal/catalog.hpp"
#include "glocal/clusters_of.hpp"
#include "loading/plugin_loader.hpp"

namespace glocal::bench {
namespace {

const Catalog& python_strategies() {
  struct Loaded : Catalog {
    Loaded() {
      PluginLoader loader(*this);
      loader.hand_over(".py", app::load_python_plugin);
      loader.load(GLOCAL_SOURCE_DIR "/bench/python_calls.py");
    }
  };
  static const Loaded loaded;
  return loaded;
}

StageSetup setup() {
  MapData data;
  data.points.push_back({});
  StageSetup setup;
  setup.map = std::make_shared<const GlobalMap>(std::move(data));
  return setup;
}

std::vector<Hypothesis> hypotheses(std::size_t n) {
  Rng rng(1);
  std::vector<Hypothesis> result;
  for (std::size_t i = 0; i < n; ++i) {
    const Pose2 pose{rng.uniform(0.0, 26.0), rng.uniform(0.0, 27.0), 0.0};
    result.push_back({.map_from_local = pose, .map_from_robot = pose, .quality = 0.5, .score = 0.5});
  }
  return result;
}

void omega_max(benchmark::State& state) {
  const auto policy = python_strategies().threshold_policies.make({"idle"}, setup());
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(policy->omega_max());
}

void update(benchmark::State& state) {
  const auto policy = python_strategies().threshold_policies.make({"idle"}, setup());
  const auto found = hypotheses(1000);
  for ([[maybe_unused]] auto _ : state) policy->update(found);
}

void match(benchmark::State& state) {
  const auto matcher = python_strategies().matchers.make({"idle"}, setup());
  LocalMap local;
  for (int i = 0; i < 2000; ++i) local.points.push_back({0.01F * static_cast<float>(i), 0.0F, 0.0F});
  local.ends = {2000};
  const Observation latest;
  Rng rng(1);
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(matcher->match({local, latest, 0.5}, rng));
}

/// What the core does with labels, in which a clusterer in C++ is no faster: to be taken off `cluster`.
void clusters_of_labels(benchmark::State& state) {
  const auto found = hypotheses(1000);
  const std::vector<std::size_t> labels(1000, 0);
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(clusters_of(found, labels));
}

void cluster(benchmark::State& state) {
  const auto clusterer = python_strategies().clusterers.make({"idle"}, setup());
  const auto found = hypotheses(1000);
  Rng rng(1);
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(clusterer->cluster(found, rng));
}

void rate(benchmark::State& state) {
  const auto rater = python_strategies().raters.make({"idle"}, setup());
  const auto found = hypotheses(1000);
  const std::vector<Cluster> clusters(100);
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(rater->rate(clusters, found));
}

void judge(benchmark::State& state) {
  const auto rule = python_strategies().verdict_rules.make({"idle"}, setup());
  StepResult step;
  step.hypotheses = hypotheses(1000);
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(rule->judge(step));
}

/// Of a thread that Python has not started, as those of trials are.
void omega_max_in_new_threads(benchmark::State& state) {
  const auto policy = python_strategies().threshold_policies.make({"idle"}, setup());
  constexpr int calls = 1000;
  for ([[maybe_unused]] auto _ : state) {
    std::thread([&] {
      for (int i = 0; i < calls; ++i) benchmark::DoNotOptimize(policy->omega_max());
    }).join();
  }
  state.counters["per_call"] = time_per_item(calls);
}

BENCHMARK(omega_max);
BENCHMARK(omega_max_in_new_threads);
BENCHMARK(update);
BENCHMARK(match);
BENCHMARK(cluster);
BENCHMARK(clusters_of_labels);
BENCHMARK(rate);
BENCHMARK(judge);

}  // namespace
}  // namespace glocal::bench

BENCHMARK_MAIN();
