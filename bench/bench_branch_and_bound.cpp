// Exact matching on a grid of poses: building the pyramid, and a match of the first and of later local maps;
// and the search for rivals of a pose.
#include <benchmark/benchmark.h>

#include <cstddef>
#include <string>
#include <vector>

#include "bench/scenes.hpp"
#include "matchers/box_search/box_pyramid.hpp"
#include "matchers/grid_search/branch_and_bound.hpp"
#include "verifiers/whole_map.hpp"

namespace glocal::bench {
namespace {

BoxPyramid pyramid_of_grid(const Scene& s) {
  constexpr auto grid = BoxPyramid::Of::pose_grid;
  return {grid, s.map(), 0.05, 0.1, BoxPyramid::default_top_level(grid)};
}

void pyramid(benchmark::State& state, const Scene& s) {
  std::size_t bytes = 0;
  for ([[maybe_unused]] auto _ : state) bytes = pyramid_of_grid(s).memory_bytes();
  state.counters["MB"] = static_cast<double>(bytes) / 1e6;
}

/// Tiles of the lowest level all over the map: what a look at a point costs.
void tiles(benchmark::State& state, const Scene& s) {
  const BoxPyramid pyramid = pyramid_of_grid(s);
  std::vector<CellPoints> points(1);
  Rng rng(1);
  for (int i = 0; i < 200; ++i) {
    points.front().push_back(static_cast<int>(rng.below(201)) - 100, static_cast<int>(rng.below(201)) - 100);
  }
  TileCounts counts;
  std::size_t points_tested = 0;
  for ([[maybe_unused]] auto _ : state) {
    points_tested = 0;
    for (int row = 0; row < pyramid.frame().rows; row += TileCounts::rows) {
      for (int column = 0; column < pyramid.frame().columns; column += TileCounts::columns) {
        points_tested += pyramid.count(0, points, column, row, 0, 0, counts);
      }
    }
  }
  state.counters["per_look"] = time_per_item(static_cast<double>(points_tested));
}

/// A local map of so many keyframes, and where it really lies.
struct PlacedMap {
  LocalMap local;
  Pose2 map_from_local;
};

/// Those of every fifth start.
std::vector<PlacedMap> local_maps(const Scene& s, std::size_t step) {
  std::vector<PlacedMap> maps;
  for (std::size_t i = 0; i < s.loaded.starts.size(); i += 5) {
    const std::size_t start = s.loaded.starts[i];
    if (start + step >= s.loaded.drive.samples.size()) continue;
    const LocalMap local = local_map_at(s, start, step);
    maps.push_back({local, true_map_from_local(s, start, step, local)});
  }
  return maps;
}

/// So many poses searched for.
void match(benchmark::State& state, const Scene& s) {
  grid_search::BranchAndBound matcher({.grid = {.max_poses = static_cast<int>(state.range(1))}},
                                      {s.loaded.map, 1});
  const std::vector<PlacedMap> maps = local_maps(s, static_cast<std::size_t>(state.range(0)));
  Rng rng(1);
  for ([[maybe_unused]] auto _ : state) {
    for (const PlacedMap& map : maps) benchmark::DoNotOptimize(matcher.match({map.local, {}, 0.1}, rng));
  }
  state.counters["per_match"] = time_per_item(static_cast<double>(maps.size()));
}

void boxes(benchmark::State& state, const Scene& s) {
  std::size_t bytes = 0;
  for ([[maybe_unused]] auto _ : state)
    bytes = BoxPyramid(BoxPyramid::Of::all_poses, s.map(), 0.025, 0.1, 4).memory_bytes();
  state.counters["MB"] = static_cast<double>(bytes) / 1e6;
}

/// Rivals of the true poses.
void verify(benchmark::State& state, const Scene& s) {
  verifiers::WholeMap verifier({}, {s.loaded.map, 1});
  const std::vector<PlacedMap> maps = local_maps(s, static_cast<std::size_t>(state.range(0)));
  for ([[maybe_unused]] auto _ : state) {
    for (const PlacedMap& map : maps)
      benchmark::DoNotOptimize(verifier.verify(map.local, Pose3(map.map_from_local), {}));
  }
  state.counters["per_pose"] = time_per_item(static_cast<double>(maps.size()));
}

}  // namespace

void register_all() {
  if (!has_datasets()) return;
  const auto add = [](const std::string& log, const std::string& name, auto run) {
    return benchmark::RegisterBenchmark(
               (name + "/" + log).c_str(),
               [run, log](benchmark::State& state) { run(state, scene("indexed", log)); })
        ->Unit(benchmark::kMillisecond);
  };
  for (const char* log : {"intel", "fhw"}) {
    add(log, "build/pyramid", pyramid);
    add(log, "tiles", tiles);
    add(log, "build/boxes", boxes);
    add(log, "verify", verify)->Arg(2)->Arg(10)->ArgName("step");
    add(log, "match", match)->ArgsProduct({{0, 20}, {1, 50}})->ArgNames({"step", "poses"});
  }
}

}  // namespace glocal::bench
