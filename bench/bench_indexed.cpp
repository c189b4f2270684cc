// Matching against an index of the map: what building it costs, and a step with it.
#include <benchmark/benchmark.h>

#include <cstddef>
#include <string>
#include <vector>

#include "bench/scenes.hpp"
#include "glocal/clearance_grid.hpp"
#include "glocal/contact.hpp"
#include "glocal/distance_field.hpp"
#include "glocal/evenly.hpp"
#include "matchers/common/oriented_points.hpp"
#include "matchers/indexed_ransam/indexed_ransam.hpp"
#include "matchers/indexed_ransam/oriented_pair_index.hpp"
#include "matchers/indexed_ransam/proposals.hpp"
#include "matchers/indexed_ransam/triangle_index.hpp"

namespace glocal::bench {
namespace {

void oriented_points(benchmark::State& state, const Scene& s) {
  for ([[maybe_unused]] auto _ : state)
    benchmark::DoNotOptimize(oriented_points_of(*s.loaded.map, OrientedPointRule{}));
}

/// An index that `make(threads)` builds, with so many entries of this name.
template <class Make>
void build(benchmark::State& state, const char* entries, Make make) {
  std::size_t bytes = 0;
  std::size_t n = 0;
  for ([[maybe_unused]] auto _ : state) {
    const auto index = make(static_cast<int>(state.range(0)));
    bytes = index.memory_bytes();
    n = index.size();
  }
  state.counters[entries] = static_cast<double>(n);
  state.counters["MB"] = static_cast<double>(bytes) / 1e6;
}

void pairs(benchmark::State& state, const Scene& s) {
  const OrientedPoints found = oriented_points_of(*s.loaded.map, {});
  build(state, "oriented_pairs",
        [&](int threads) { return indexed_ransam::OrientedPairIndex(found, {}, threads); });
}

void triangles(benchmark::State& state, const Scene& s) {
  const Points found = downsampled_in_plane(s.map(), 0.1);
  constexpr TriangleRule rule{.min_side = 0.5, .min_height = 0.3, .max_side = 6.0};
  build(state, "triangles",
        [&](int threads) { return indexed_ransam::TriangleIndex(found, rule, 1'000'000, threads); });
}

/// Full batches of motions that oriented point pairs of a local map propose.
std::vector<MotionBatch> proposals(const Scene& s, const LocalMap& local, std::size_t batches) {
  const indexed_ransam::RelationRule rule{.relation = "oriented_pair"};
  const auto index = indexed_ransam::relation_index(*s.loaded.map, rule, 1);
  std::vector<MotionBatch> result;
  Rng rng(1);
  while (result.size() < batches) {
    indexed_ransam::propose(*index, rule, local, 4 * MotionBatch::capacity, rng,
                            [&](const MotionBatch& motions, std::size_t size) {
                              if (size == MotionBatch::capacity && result.size() < batches)
                                result.push_back(motions);
                            });
  }
  return result;
}

/// What spares most proposed poses a look at 128 points. `coarse`: 16 points against the coarse bits, as
/// IndexedRansam does. `third_point`: another point of the local map must be in contact (Winkelbach et al.
/// 2006). Or both. `kept` is the share of poses with a contact of 0.2 or more that are not lost.
void looks(benchmark::State& state, const Scene& s, bool third_point, bool coarse) {
  const LocalMap local = local_map_at(s, s.loaded.starts.front(), static_cast<std::size_t>(state.range(0)));
  Points sample;
  for (std::size_t i = 0; i < 128; ++i) sample.push_back(local.points[(i * 7919) % local.points.size()]);
  const std::vector<MotionBatch> all = proposals(s, local, 6);
  const auto contact = contact_index(*s.loaded.map, "bitset", 0.1);
  std::size_t passed = 0;
  const auto look = [&] {
    passed = 0;
    for (const MotionBatch& motions : all) {
      ContactIndex::BatchColumn begins{};
      ContactIndex::BatchColumn at_most{};
      at_most.fill(16);
      if (coarse) contact->count_at_most(sample, 16, motions, MotionBatch::capacity, begins, at_most);
      for (std::size_t i = 0; i < MotionBatch::capacity; ++i) {
        if (third_point && contact->count(sample, (i * 31) % 128, 1, motions[i]) == 0) continue;
        if (at_most[i] < 4) continue;  // less than 0.2 of 16
        if (contact->share(sample, motions[i]) >= 0.2) ++passed;
      }
    }
    return passed;
  };
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(look());
  std::size_t good = 0;
  for (const MotionBatch& motions : all) {
    for (std::size_t i = 0; i < MotionBatch::capacity; ++i) {
      good += contact->share(sample, motions[i]) >= 0.2 ? 1U : 0U;
    }
  }
  state.counters["kept"] = static_cast<double>(passed) / static_cast<double>(good);
  state.counters["per_pose"] = time_per_item(static_cast<double>(all.size() * MotionBatch::capacity));
}

void distances(benchmark::State& state, const Scene& s) {
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(DistanceField(s.map()));
  }
}

void clearances(benchmark::State& state, const Scene& s) {
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(ClearanceGrid(s.loaded.map->grid()));
}

/// From a pose a little off, with a hundred points.
void refinement(benchmark::State& state, const Scene& s) {
  const DistanceField field(s.map());
  const std::size_t start = s.loaded.starts.front();
  const LocalMap local = local_map_at(s, start, 10);
  const Points points = evenly_chosen(local.points, 100);
  const Pose2 map_from_local = true_map_from_local(s, start, 10, local);
  const Pose2 off = map_from_local * Pose2{0.1, -0.1, 0.05};
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(refined_pose(field, points, off, {}));
}

}  // namespace

void register_all() {
  if (!has_datasets()) return;
  const Scene& s = scene("intel");
  const auto add = [&](const std::string& name, auto run) {
    return benchmark::RegisterBenchmark(name.c_str(), [run, &s](benchmark::State& state) { run(state, s); })
        ->Unit(benchmark::kMillisecond);
  };
  add("build/oriented_points", oriented_points);
  add("build/oriented_pairs", pairs)->Arg(1)->Arg(2);
  add("build/triangles", triangles)->Arg(1)->Arg(2);
  add("look/none", [](auto& state, const Scene& scene) { looks(state, scene, false, false); })
      ->Arg(0)
      ->Arg(20);
  add("look/coarse", [](auto& state, const Scene& scene) { looks(state, scene, false, true); })
      ->Arg(0)
      ->Arg(20);
  add("look/third_point", [](auto& state, const Scene& scene) { looks(state, scene, true, false); })
      ->Arg(0)
      ->Arg(20);
  add("look/both", [](auto& state, const Scene& scene) { looks(state, scene, true, true); })->Arg(0)->Arg(20);
  add("build/distance_field", distances);
  add("build/clearance_grid", clearances);
  add("first_match",
      [](auto& state, const Scene& scene) {
        first_matches<indexed_ransam::IndexedRansam>(state, scene, {}, 0.1, 1);
      })
      ->Arg(0)
      ->Arg(20);
  add("refinement", refinement)->Unit(benchmark::kMicrosecond);
}

}  // namespace glocal::bench
