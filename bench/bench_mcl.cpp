// Monte Carlo localization: a step of the filter with all its particles, and its inner loop.
#include <benchmark/benchmark.h>

#include <cstddef>
#include <string>

#include "bench/scenes.hpp"
#include "glocal/evenly.hpp"
#include "matchers/mcl/likelihood_field.hpp"
#include "matchers/mcl/mcl.hpp"
#include "matchers/mcl/odometry_motion.hpp"

namespace glocal::bench {
namespace {

const Observation& first_observation(const Scene& s) {
  return s.loaded.drive.samples[s.loaded.starts.front()].observation;
}

/// The first step: 40,000 particles, 60 beams.
void first_step(benchmark::State& state, const Scene& s, const std::string& model) {
  const LocalMap local = local_map_at(s, s.loaded.starts.front(), 0);
  mcl::Mcl matcher({.max_particles = 40000, .laser_model_type = model, .laser_max_range = 20.0},
                   {s.loaded.map, static_cast<int>(state.range(0))});
  Rng rng(1);
  for ([[maybe_unused]] auto _ : state) {
    matcher.reset();
    benchmark::DoNotOptimize(matcher.match({local, first_observation(s), 0.0}, rng));
  }
  state.counters["per_particle"] = time_per_item(40000);
}

/// Poses all over the map, and 60 ends of beams.
struct Lookups {
  explicit Lookups(const Scene& s) : ends(evenly_chosen(first_observation(s).scan.hits, 60)) {
    const auto space = mcl::free_space(*s.loaded.map);
    Rng rng(1);
    for (std::size_t i = 0; i < MotionBatch::capacity; ++i) {
      const Transform t(space->draw(rng));
      poses.cosine[i] = t.cosine();
      poses.sine[i] = t.sine();
      poses.x[i] = t.x();
      poses.y[i] = t.y();
    }
  }
  Points ends;
  MotionBatch poses;
};

void field_in_vectors(benchmark::State& state, const Scene& s) {
  const mcl::LikelihoodField field(*s.loaded.map, {}, [](double p) { return p * p * p; });
  const Lookups lookups(s);
  mcl::LikelihoodField::Sums sums{};
  for ([[maybe_unused]] auto _ : state) {
    field.sum(lookups.ends, lookups.poses, MotionBatch::capacity, sums);
    benchmark::DoNotOptimize(sums);
  }
  state.counters["per_look"] = time_per_item(60.0 * MotionBatch::capacity);
}

void field_one_by_one(benchmark::State& state, const Scene& s) {
  const mcl::LikelihoodField field(*s.loaded.map, {}, [](double p) { return p * p * p; });
  const Lookups lookups(s);
  for ([[maybe_unused]] auto _ : state) {
    for (std::size_t i = 0; i < MotionBatch::capacity; ++i) {
      float sum = 0.0F;
      for (std::size_t k = 0; k < lookups.ends.size(); ++k) {
        const Point p = lookups.poses[i](lookups.ends[k]);
        sum += field.at(p.x, p.y);
      }
      benchmark::DoNotOptimize(sum);
    }
  }
  state.counters["per_look"] = time_per_item(60.0 * MotionBatch::capacity);
}

void motion(benchmark::State& state, const Scene& /*s*/) {
  const mcl::OdometryMotion moved({0.25, 0.0, 0.1}, {});
  Rng rng(1);
  Pose2 pose;
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(pose = moved.sample(pose, rng));
}

void build_field(benchmark::State& state, const Scene& s) {
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(mcl::LikelihoodField(*s.loaded.map, {}, [](double p) { return p * p * p; }));
  }
}

}  // namespace

void register_all() {
  if (!has_datasets()) return;
  const Scene& s = scene("mcl", "intel");
  const auto add = [&](const std::string& name, auto run) {
    return benchmark::RegisterBenchmark(name.c_str(), [run, &s](benchmark::State& state) { run(state, s); });
  };
  for (const std::string model : {"likelihood_field", "likelihood_field_prob", "beam"}) {
    add("first_step/" + model, [model](auto& state, const Scene& scene) { first_step(state, scene, model); })
        ->Arg(1)
        ->Arg(2)
        ->Unit(benchmark::kMillisecond);
  }
  add("field/vectors", field_in_vectors)->Unit(benchmark::kMicrosecond);
  add("field/one_by_one", field_one_by_one)->Unit(benchmark::kMicrosecond);
  add("motion", motion);
  add("build/field", build_field)->Unit(benchmark::kMillisecond);
}

}  // namespace glocal::bench
