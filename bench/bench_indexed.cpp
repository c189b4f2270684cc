// Matching against an index of the map: what building it costs, and a step with it.
#include <benchmark/benchmark.h>

#include <cstddef>
#include <string>
#include <vector>

#include "bench/scenes.hpp"
#include "matchers/beam_evidence.hpp"
#include "matchers/dipole_index.hpp"
#include "matchers/distance_field.hpp"
#include "matchers/indexed_ransam.hpp"
#include "matchers/surfaces.hpp"

namespace glocal::bench {
namespace {

void surfaces(benchmark::State& state, const Scene& s) {
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(surfaces_of(*s.prepared.map, SurfaceRule{}));
}

void dipoles(benchmark::State& state, const Scene& s) {
  const Surfaces found = surfaces_of(*s.prepared.map, {});
  std::size_t bytes = 0;
  std::size_t n = 0;
  for ([[maybe_unused]] auto _ : state) {
    const DipoleIndex index(found, {});
    bytes = index.memory_bytes();
    n = index.size();
  }
  state.counters["dipoles"] = static_cast<double>(n);
  state.counters["MB"] = static_cast<double>(bytes) / 1e6;
}

void distances(benchmark::State& state, const Scene& s) {
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(DistanceField(s.map()));
  }
}

void clearances(benchmark::State& state, const Scene& s) {
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(ClearanceGrid(s.prepared.map->grid()));
}

/// One match of a local map of so many key frames, as the first one of a drive.
void first_match(benchmark::State& state, const Scene& s) {
  IndexedRansam matcher({}, {s.prepared.map, 1});
  std::vector<LocalMap> locals;
  for (const std::size_t start : s.prepared.starts) {
    locals.push_back(local_map_at(s, start, static_cast<std::size_t>(state.range(0))));
  }
  Rng rng(1);
  for ([[maybe_unused]] auto _ : state) {
    for (const LocalMap& local : locals) {
      matcher.reset();
      benchmark::DoNotOptimize(matcher.match(local, {}, 0.1, rng));
    }
  }
  state.counters["per_match"] = time_per_item(static_cast<double>(locals.size()));
}

/// From a pose a little off, with a hundred points.
void refinement(benchmark::State& state, const Scene& s) {
  const DistanceField field(s.map());
  const std::size_t start = s.prepared.starts.front();
  const LocalMap local = local_map_at(s, start, 10);
  Points points;
  for (std::size_t i = 0; i < 100; ++i) points.push_back(local.points[i * local.points.size() / 100]);
  const Pose2 map_from_local =
      s.prepared.drive.samples[start + 10].map_from_robot.value() * inverse(local.local_from_robot);
  const Pose2 off = map_from_local * Pose2{0.1, -0.1, 0.05};
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(refined_pose(field, points, off, {}));
}

void register_all() {
  if (!has_datasets()) return;
  const Scene& s = scene("intel");
  const auto add = [&](const std::string& name, auto run) {
    return benchmark::RegisterBenchmark(name.c_str(), [run, &s](benchmark::State& state) { run(state, s); })
        ->Unit(benchmark::kMillisecond);
  };
  add("build/surfaces", surfaces);
  add("build/dipoles", dipoles);
  add("build/distance_field", distances);
  add("build/clearance_grid", clearances);
  add("first_match", first_match)->Arg(0)->Arg(20);
  add("refinement", refinement)->Unit(benchmark::kMicrosecond);
}

}  // namespace
}  // namespace glocal::bench

int main(int argc, char** argv) {
  return glocal::bench::run_registered(argc, argv, glocal::bench::register_all);
}
