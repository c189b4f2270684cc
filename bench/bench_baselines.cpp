// The baselines: brute force, plain RANSAC, and RANSAC over features, on the same local maps.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bench/scenes.hpp"
#include "matchers/grid_search/exhaustive.hpp"
#include "matchers/iransac/feature_index.hpp"
#include "matchers/iransac/iransac.hpp"
#include "matchers/ransac/ransac.hpp"

namespace glocal::bench {
namespace {

/// A local map's features among those of the whole map; the share of the ten nearest that are found.
void nearest(benchmark::State& state, const Scene& s, const std::optional<iransac::HashRule>& hashing) {
  const OrientedPoints oriented_points = oriented_points_of(*s.loaded.map, {});
  const iransac::FeatureIndex all(oriented_points, {}, std::nullopt, 1);
  const iransac::FeatureIndex index(oriented_points, {}, hashing, 1);
  const LocalMap local = local_map_at(s, s.loaded.starts.front(), 10);
  std::vector<std::uint32_t> drawn;
  const OrientedPoints seen = oriented_points_of(local, OrientedPointRule{});
  for (std::uint32_t i = 0; i < seen.size(); i += 20) drawn.push_back(i);
  const iransac::FeatureVectors features = iransac::shape_contexts(seen, drawn, {});
  for ([[maybe_unused]] auto _ : state) {
    for (std::size_t i = 0; i < features.size(); ++i)
      benchmark::DoNotOptimize(index.nearest(features[i], 10));
  }
  double found = 0.0;
  for (std::size_t i = 0; i < features.size(); ++i) {
    const auto exact = all.nearest(features[i], 10);
    for (const std::uint32_t number : index.nearest(features[i], 10))
      found += std::ranges::find(exact, number) == exact.end() ? 0.0 : 0.1;
  }
  state.counters["found"] = found / static_cast<double>(features.size());
  state.counters["per_feature"] = time_per_item(static_cast<double>(features.size()));
}

}  // namespace

void register_all() {
  const auto add = [](const std::string& name, auto run) {
    return benchmark::RegisterBenchmark(name.c_str(), run)->Unit(benchmark::kMillisecond);
  };
  add("exhaustive/paper_lab", [](benchmark::State& state) {
    const grid_search::GridRule grid{
        .contact_epsilon = 0.15, .cell = 0.15, .min_rotation_step_deg = 1.15, .max_points = 100};
    first_matches<grid_search::Exhaustive>(state, scene("paper_lab"), {.matching = {.grid = grid}}, 0.3, 5);
  })->Arg(0);
  if (!has_datasets()) return;
  add("ransac/intel",
      [](benchmark::State& state) { first_matches<ransac::Ransac>(state, scene("intel"), {}, 0.55, 5); })
      ->Arg(0)
      ->Arg(20);
  for (const bool lsh : {false, true}) {
    const std::string how = lsh ? "/lsh" : "/all";
    add("iransac/intel" + how,
        [lsh](benchmark::State& state) {
          first_matches<iransac::IRansac>(state, scene("indexed", "intel"), {.lsh = lsh}, 0.1, 5);
        })
        ->Arg(0)
        ->Arg(20);
    add("nearest/intel" + how, [lsh](benchmark::State& state) {
      nearest(state, scene("indexed", "intel"), lsh ? std::optional(iransac::HashRule{}) : std::nullopt);
    });
  }
}

}  // namespace glocal::bench
