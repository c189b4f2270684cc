// Drawing triples: one by one, in batches, and near each other; and what near draws are worth to a match.
#include <benchmark/benchmark.h>

#include <cstddef>
#include <cstdint>

#include "bench/plain.hpp"
#include "bench/scenes.hpp"
#include "matchers/common/triple_sampler.hpp"
#include "matchers/ransam/ransam.hpp"

namespace glocal::bench {
namespace {

void plain_draws(benchmark::State& state) {
  const Points& map = simulation().map();
  Rng rng(1);
  for ([[maybe_unused]] auto _ : state) {
    for (std::size_t i = 0; i < TripleBatch::capacity; ++i) {
      Triple triple = plain::draw(map, rng);
      benchmark::DoNotOptimize(triple);
    }
  }
  state.counters["per_triple"] = time_per_item(TripleBatch::capacity);
}

/// Argument: radius in decimetres; 0 draws from all points.
void batches(benchmark::State& state) {
  const TripleSampler sampler(simulation().map(), static_cast<double>(state.range(0)) / 10.0);
  TripleBatch batch;
  for (std::uint32_t i = 0; i < TripleBatch::capacity; ++i) batch.add_number(i);
  std::uint64_t seed = 0;
  for ([[maybe_unused]] auto _ : state) {
    sampler.draw(++seed, batch);
    benchmark::DoNotOptimize(batch);
  }
  state.counters["per_triple"] = time_per_item(TripleBatch::capacity);
}

/// The same argument. Triples near each other meet their partners more often.
void match_after_20_steps(benchmark::State& state) {
  constexpr std::size_t step = 20;
  constexpr double omega_max = 0.75;
  const LocalMap local = local_map_at(simulation(), 0, step);
  ransam::TripleSearch triples{
      .contact_epsilon = 0.05, .relation_cell = 0.15, .min_side = 0.6, .min_height = 0.3};
  triples.local_radius = static_cast<double>(state.range(0)) / 10.0;
  ransam::Ransam ransam({.triples = triples}, {simulation().loaded.map, 1});
  Rng rng(1);
  std::size_t proposals = 0;
  std::size_t hypotheses = 0;
  for ([[maybe_unused]] auto _ : state) {
    const MatchResult result = ransam.match({local, {}, omega_max}, rng);
    proposals += result.proposals;
    hypotheses += result.hypotheses.size();
  }
  state.counters["proposals"] = per_iteration(proposals);
  state.counters["hypotheses"] = per_iteration(hypotheses);
}

BENCHMARK(reference_loop)->Unit(benchmark::kMillisecond);
BENCHMARK(plain_draws);
BENCHMARK(batches)->Arg(0)->Arg(20)->Arg(80);
BENCHMARK(match_after_20_steps)->Arg(0)->Arg(20)->Arg(40)->Arg(80)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace glocal::bench

BENCHMARK_MAIN();
