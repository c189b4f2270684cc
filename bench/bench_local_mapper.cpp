// Time of scan_matching and bounded per keyframe: it must not grow with the drive.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "bench/scenes.hpp"
#include "glocal/rng.hpp"
#include "local_mappers/bounded.hpp"
#include "local_mappers/scan_matching.hpp"

namespace glocal::bench {
namespace {

constexpr double keyframe_m = 0.25;
/// Wheels that go 2 % too far and turn half a degree per metre.
constexpr Pose2 biased_step{1.02 * keyframe_m, 0.0, 0.002};

/// A corridor 3 m wide with a pier every 2 m on the left and every 3 m on the right, seen by a laser with 361
/// beams. The piers' depths come from a hash and repeat every 30 m, so that drives that are longer by a
/// multiple of that end in the same surroundings.
double wall_distance(double x, bool left) {
  const int spacing = left ? 2 : 3;
  const int number = static_cast<int>(std::floor(x / spacing));
  const bool pier = x - number * spacing < 0.4;
  const int kinds = 30 / spacing;
  const int kind = ((number % kinds) + kinds) % kinds;
  return pier ? 1.4 - 0.5 * Rng(static_cast<std::uint64_t>(kind * 2 + (left ? 1 : 0))).uniform() : 1.5;
}

/// Range by marching along the ray, up to 20 m.
double range(double robot_x, double angle) {
  const double dx = std::cos(angle);
  const double dy = std::sin(angle);
  for (double r = 0.5; r < 20.0; r += 0.01) {
    const double y = r * dy;
    if (std::abs(y) >= wall_distance(robot_x + r * dx, y > 0.0)) return r;
  }
  return 20.0;
}

std::vector<Observation> drive(int keyframes) {
  std::vector<Observation> observations;
  Rng rng(1);
  Pose2 odom_from_robot;
  for (int k = 0; k < keyframes; ++k) {
    Observation observation;
    observation.odom_from_robot = odom_from_robot;
    odom_from_robot = odom_from_robot * biased_step;
    for (int i = 0; i <= 360; ++i) {
      const double angle = radians(0.5 * i - 90.0);
      const double r = range(k * keyframe_m, angle);
      if (r >= 20.0) continue;
      const double noisy = r + rng.normal(0.01);
      observation.scan.hits.push_back(
          {static_cast<float>(noisy * std::cos(angle)), static_cast<float>(noisy * std::sin(angle)), 0.0F});
    }
    observations.push_back(std::move(observation));
  }
  return observations;
}

/// The last 20 keyframes (5 m) of a drive of so many metres.
template <class Mapper>
void last_keyframes_of_a_drive(benchmark::State& state) {
  constexpr std::size_t measured = 20;
  const std::vector<Observation> observations =
      drive(static_cast<int>(static_cast<double>(state.range(0)) / keyframe_m));
  Mapper mapper({});
  for ([[maybe_unused]] auto _ : state) {
    state.PauseTiming();
    mapper.reset();
    for (std::size_t i = 0; i + measured < observations.size(); ++i) mapper.add(observations[i]);
    state.ResumeTiming();
    for (std::size_t i = observations.size() - measured; i < observations.size(); ++i)
      mapper.add(observations[i]);
  }
  state.counters["per_keyframe"] = time_per_item(measured);
  state.counters["points"] = static_cast<double>(mapper.map().points.size());
  state.counters["index_MB"] = static_cast<double>(mapper.grid().memory_bytes()) / 1e6;
  // Says that the mapper kept up: about the way driven.
  state.counters["way_m"] = std::hypot(mapper.map().local_from_robot.x, mapper.map().local_from_robot.y);
}
void drives_of_10_to_640_m(benchmark::internal::Benchmark* timed) {
  for (const int metres : {10, 40, 160, 640}) timed->Arg(metres);
  timed->Iterations(10)->Unit(benchmark::kMillisecond);
}
BENCHMARK(reference_loop)->Unit(benchmark::kMillisecond);
BENCHMARK(last_keyframes_of_a_drive<local_mappers::ScanMatching>)->Apply(drives_of_10_to_640_m);
BENCHMARK(last_keyframes_of_a_drive<local_mappers::Bounded>)->Apply(drives_of_10_to_640_m);

}  // namespace
}  // namespace glocal::bench

BENCHMARK_MAIN();
