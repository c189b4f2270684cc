// The same task for glocal's matcher and for what PCL offers: one local map, one global map, no idea where.
// Built only where plugins/pcl is.
#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "bench/scenes.hpp"
#include "glocal/builtin.hpp"
#include "loading/plugin_loader.hpp"

namespace glocal::bench {
namespace {

constexpr std::size_t steps = 20;

/// The local map a robot has after some keyframes from each start of the experiment.
struct Task {
  LocalMap local;
  Pose3 map_from_robot;  ///< The truth.
};

std::vector<Task> tasks(const Scene& scene) {
  std::vector<Task> result;
  for (const std::size_t start : scene.loaded.starts) {
    result.push_back({local_map_at(scene, start, steps),
                      scene.loaded.drive.samples[start + steps].map_from_robot.value()});
  }
  return result;
}

bool is_right(const MatchResult& result, const Task& task, const EvaluationConfig& limits) {
  if (result.hypotheses.empty()) return false;
  const Pose3 pose = result.hypotheses.front().map_from_local * task.local.local_from_robot;
  return distance(pose, task.map_from_robot) <= limits.max_translation_error &&
         rotation_between(pose, task.map_from_robot) <= radians(limits.max_rotation_error_deg);
}

/// One pass over all tasks; counts those whose best hypothesis is within the experiment's limits. Making the
/// matcher, which looks at the map, is not timed.
void peer(benchmark::State& state, const StrategyChoice& choice, const Catalog& catalog) {
  constexpr double omega_max = 0.3;
  const Scene& s = scene("intel");
  const std::vector<Task> all = tasks(s);
  const auto matcher = catalog.matchers.make(choice, {s.loaded.map, 1});
  Rng rng(1);
  std::size_t right = 0;
  for ([[maybe_unused]] auto _ : state) {
    right = 0;
    for (const Task& task : all) {
      if (is_right(matcher->match({task.local, {}, omega_max}, rng), task, s.experiment.evaluation)) ++right;
    }
  }
  state.counters["right"] = static_cast<double>(right);
  state.counters["of"] = static_cast<double>(all.size());
  state.counters["per_match"] = time_per_item(static_cast<double>(all.size()));
}

}  // namespace

void register_all() {
  if (!has_datasets()) return;
  struct Peers : Catalog {
    Peers() {
      register_builtin_strategies(*this);
      PluginLoader(*this).load(GLOCAL_PCL_PLUGIN);
    }
  };
  static const Peers catalog;
  const auto add = [](const char* name, const StrategyChoice& choice) {
    return benchmark::RegisterBenchmark(name,
                                        [choice](benchmark::State& state) { peer(state, choice, catalog); })
        ->Unit(benchmark::kMillisecond);
  };
  add("glocal_ransam", scene("intel").experiment.localizer.matcher);
  add("pcl_prerejective", {"pcl_prerejective"})->Iterations(1);
  add("pcl_icp", {"pcl_icp"})->Iterations(1);
}

}  // namespace glocal::bench
