// Whole localization steps: local map, match, clusters, ratings and verdict.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cstddef>
#include <string>

#include "bench/scenes.hpp"
#include "evaluation/running/trials.hpp"

namespace glocal::bench {
namespace {

/// Steps [begin, end) of the first trial of an experiment, and the share of each stage.
void steps(benchmark::State& state, const std::string& name, std::size_t begin, std::size_t end,
           int threads) {
  const Scene& s = scene(name);
  Localizer localizer(s.experiment.localizer, catalog(), {s.loaded.map, threads},
                      seed_of(RandomPart::localizer, s.experiment));
  const auto step = [&](std::size_t i) {
    const Sample& sample = s.loaded.drive.samples[s.loaded.starts.front() + i];
    return waited_for(localizer, localizer.step(sample.observation));
  };
  StageTimes times;
  for ([[maybe_unused]] auto _ : state) {
    state.PauseTiming();
    localizer.reset(0);
    for (std::size_t i = 0; i < begin; ++i) static_cast<void>(step(i));
    state.ResumeTiming();
    for (std::size_t i = begin; i < end; ++i) {
      const StepResult result = step(i);
      times.local_map += result.stage_ms.local_map;
      times.match += result.stage_ms.match;
      times.cluster += result.stage_ms.cluster;
    }
  }
  const auto per_step = [&](double total_ms) {
    return benchmark::Counter(total_ms / static_cast<double>(end - begin),
                              benchmark::Counter::kAvgIterations);
  };
  state.counters["per_step"] = time_per_item(static_cast<double>(end - begin));
  state.counters["local_map_ms"] = per_step(times.local_map);
  state.counters["match_ms"] = per_step(times.match);
  state.counters["cluster_ms"] = per_step(times.cluster);
}

void register_steps(const std::string& name, std::size_t begin, std::size_t end) {
  for (const int threads : {1, 2}) {
    const std::string full_name = fmt::format("{}/{}_to_{}/threads:{}", name, begin, end, threads);
    benchmark::RegisterBenchmark(full_name.c_str(),
                                 [=](auto& state) { steps(state, name, begin, end, threads); })
        ->UseRealTime()
        ->Iterations(3)
        ->Unit(benchmark::kMillisecond);
  }
}

}  // namespace

void register_all() {
  register_steps("paper_simulation", 0, 5);
  register_steps("paper_simulation", 90, 130);
  if (has_datasets()) register_steps("intel", 0, 40);
}

}  // namespace glocal::bench
