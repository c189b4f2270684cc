// Whole matches of the paper's simulation: everything Matcher::match does.
#include <benchmark/benchmark.h>

#include <cstddef>
#include <memory>

#include "bench/scenes.hpp"
#include "glocal/contact.hpp"
#include "matchers/ransam/ransam.hpp"

namespace glocal::bench {
namespace {

constexpr std::size_t late_step = 110;
/// What eq. 9 asks for in the first and in late steps.
constexpr double first_omega_max = 0.6;
constexpr double late_omega_max = 0.75;

void match(benchmark::State& state, const std::shared_ptr<const GlobalMap>& map, std::size_t step,
           int threads) {
  const LocalMap local = local_map_at(simulation(), 0, step);
  const auto matcher = make_matcher(simulation(), map, threads);
  Rng rng(1);
  MatchResult result;
  std::size_t proposals = 0;
  for ([[maybe_unused]] auto _ : state) {
    result = matcher->match({local, {}, step == 0 ? first_omega_max : late_omega_max}, rng);
    proposals += result.proposals;
  }
  state.counters["map_points"] = static_cast<double>(map->points().size());
  state.counters["local_points"] = static_cast<double>(local.points.size());
  state.counters["proposals"] = per_iteration(proposals);
}

/// Argument: the step; 0 is the flood of the first one.
void growing_local_map(benchmark::State& state) {
  match(state, simulation().loaded.map, static_cast<std::size_t>(state.range(0)), 1);
}

/// Argument: how often the map is laid side by side in each direction.
void growing_map(benchmark::State& state) {
  const auto map = tiled_map(static_cast<int>(state.range(0)));
  match(state, map, late_step, 1);
  constexpr double epsilon = 0.05;  // As in paper_simulation.yaml.
  state.counters["contact_MB"] =
      static_cast<double>(contact_index(*map, "bitset", epsilon)->memory_bytes()) / 1e6;
}

void threads(benchmark::State& state) {
  match(state, simulation().loaded.map, late_step, static_cast<int>(state.range(0)));
}

/// What a split into partitions with a table each would find, as in the parallel form the paper cites: so
/// many matches, of a share of the draws each.
void separate_tables(benchmark::State& state) {
  const auto partitions = static_cast<int>(state.range(0));
  const LocalMap local = local_map_at(simulation(), 0, late_step);
  ransam::Ransam ransam({.triples = {.iterations = 200'000 / partitions,
                                     .contact_epsilon = 0.05,
                                     .relation_cell = 0.15,
                                     .min_side = 1.5,
                                     .min_height = 1.0}},
                        {simulation().loaded.map, 1});
  Rng rng(1);
  std::size_t proposals = 0;
  for ([[maybe_unused]] auto _ : state) {
    for (int i = 0; i < partitions; ++i)
      proposals += ransam.match({local, {}, late_omega_max}, rng).proposals;
  }
  state.counters["proposals"] = per_iteration(proposals);
}

BENCHMARK(reference_loop)->Unit(benchmark::kMillisecond);
BENCHMARK(growing_local_map)->Arg(0)->Arg(10)->Arg(30)->Arg(60)->Arg(110)->Unit(benchmark::kMillisecond);
BENCHMARK(growing_map)->Arg(1)->Arg(2)->Arg(4)->Arg(8)->Unit(benchmark::kMillisecond);
BENCHMARK(threads)->Arg(1)->Arg(2)->UseRealTime()->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);
BENCHMARK(separate_tables)->RangeMultiplier(2)->Range(1, 16)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace glocal::bench

BENCHMARK_MAIN();
