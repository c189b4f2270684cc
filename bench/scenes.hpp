// What the benchmarks look at: experiments from configs/, and maps as large as one likes.
#pragma once

#include <benchmark/benchmark.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "evaluation/running/experiment_loader.hpp"
#include "glocal/experiment.hpp"
#include "glocal/global_map.hpp"
#include "glocal/local_map.hpp"
#include "glocal/rng.hpp"

namespace glocal::bench {

/// An experiment with its map, drive and starts loaded.
struct Scene {
  Experiment experiment;
  LoadedExperiment loaded;

  [[nodiscard]] const Points& map() const { return loaded.map->points(); }
};

/// configs/experiments/NAME.yaml, loaded once. Experiments on recorded drives need GLOCAL_DATASETS.
[[nodiscard]] const Scene& scene(const std::string& name);
/// A built-in method on a built-in case, loaded once.
[[nodiscard]] const Scene& scene(const std::string& method, const std::string& case_name);
/// The paper's simulated drive.
[[nodiscard]] inline const Scene& simulation() {
  return scene("paper_simulation");
}
/// Whether scene("intel") and the like can be had.
[[nodiscard]] bool has_datasets();

/// Every strategy, to make stages from.
[[nodiscard]] const Catalog& catalog();

/// The matcher of an experiment on another map or with more threads.
[[nodiscard]] std::unique_ptr<Matcher> make_matcher(const Scene& scene, std::shared_ptr<const GlobalMap> map,
                                                    int threads);

/// The local map after `step` + 1 observations from sample `start` on.
[[nodiscard]] LocalMap local_map_at(const Scene& scene, std::size_t start, std::size_t step);

/// Where that local map really lies in the global map.
[[nodiscard]] Pose2 true_map_from_local(const Scene& scene, std::size_t start, std::size_t step,
                                        const LocalMap& local);

/// The simulation's map, n x n times side by side. Each copy is mirrored or turned and lacks some stretches
/// of its walls, so that only the first shows what the robot sees.
[[nodiscard]] std::shared_ptr<const GlobalMap> tiled_map(int n);

/// `n` points on walls of a building as large as they need at 3 cm.
[[nodiscard]] Points walls(std::size_t n);

/// The time of one of the `items` of each iteration, in seconds.
[[nodiscard]] inline benchmark::Counter time_per_item(double items) {
  return {items, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert};
}

/// What was counted over all iterations, for one of them.
[[nodiscard]] inline benchmark::Counter per_iteration(std::size_t total) {
  return {static_cast<double>(total), benchmark::Counter::kAvgIterations};
}

/// A first match of the local maps of so many keyframes, at every so many starts.
template <class Kind>
void first_matches(benchmark::State& state, const Scene& s, const typename Kind::Params& params,
                   double omega_max, std::size_t every) {
  Kind matcher(params, {s.loaded.map, 1});
  std::vector<LocalMap> locals;
  for (std::size_t i = 0; i < s.loaded.starts.size(); i += every) {
    locals.push_back(local_map_at(s, s.loaded.starts[i], static_cast<std::size_t>(state.range(0))));
  }
  Rng rng(1);
  for ([[maybe_unused]] auto _ : state) {
    for (const LocalMap& local : locals) {
      matcher.reset();
      benchmark::DoNotOptimize(matcher.match({local, {}, omega_max}, rng));
    }
  }
  state.counters["per_match"] = time_per_item(static_cast<double>(locals.size()));
}

/// Registers the benchmarks of a program with bench_main.cpp, which has the reference loop already.
void register_all();

/// So that times can be compared over machines and days as multiples of it: 200,000 triples of the map and as
/// many of a late local map, drawn one at a time in plain code, hashed and looked up in a table of 8-byte
/// entries, and nothing else.
class ReferenceLoop {
 public:
  ReferenceLoop();
  void run();

 private:
  LocalMap local_;
  std::vector<std::uint64_t> table_;
  Rng rng_{1};
};

/// To be registered in every benchmark.
void reference_loop(benchmark::State& state);

}  // namespace glocal::bench
