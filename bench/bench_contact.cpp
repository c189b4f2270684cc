// Time to find the contact of one point, the transform included: kd-tree, byte grid and bitset.
#include <benchmark/benchmark.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "bench/plain.hpp"
#include "bench/scenes.hpp"
#include "glocal/contact.hpp"
#include "glocal/rng.hpp"

namespace glocal::bench {
namespace {

constexpr double epsilon = 0.1;
constexpr std::size_t queries = 3000;

/// Poses all over the map.
std::vector<Transform> poses(const Points& map) {
  Rng rng(7);
  std::vector<Transform> result;
  for (int i = 0; i < 64; ++i) {
    const std::size_t at = rng.below(static_cast<std::uint32_t>(map.size()));
    result.emplace_back(Pose2{map.x[at], map.y[at], rng.uniform(-3.0, 3.0)});
  }
  return result;
}

/// `count(transform, points)` for one pose after the other; reports the time for a point.
template <class Count>
void count_contacts_of(benchmark::State& state, const Points& map, std::size_t memory_bytes, Count count) {
  const std::vector<Transform> transforms = poses(map);
  const Points points = walls(queries);
  std::size_t i = 0;
  std::size_t in_contact = 0;
  for ([[maybe_unused]] auto _ : state) in_contact += count(transforms[i++ % transforms.size()], points);
  benchmark::DoNotOptimize(in_contact);
  state.counters["per_point"] = time_per_item(static_cast<double>(queries));
  state.counters["memory_MB"] = static_cast<double>(memory_bytes) / 1e6;
}

template <class Index>
void index(benchmark::State& state, const Points& map) {
  const Index contact(map, epsilon);
  count_contacts_of(state, map, contact.memory_bytes(),
                    [&](const Transform& transform, const Points& points) {
                      return contact.count(points, 0, points.size(), transform);
                    });
}

void byte_grid(benchmark::State& state, const Points& map) {
  const plain::ByteGrid grid(map, epsilon);
  count_contacts_of(state, map, grid.memory_bytes(), [&](const Transform& transform, const Points& points) {
    std::size_t in_contact = 0;
    for (std::size_t i = 0; i < points.size(); ++i) in_contact += grid.contact(transform(points[i])) ? 1 : 0;
    return in_contact;
  });
}

void register_for(const std::string& name, const std::shared_ptr<const Points>& map) {
  // A fixed number, so that large indexes are built only once.
  constexpr int iterations = 4096;
  const auto add = [&](const std::string& what, auto run) {
    benchmark::RegisterBenchmark((what + "/" + name).c_str(), [map, run](auto& state) {
      run(state, *map);
    })->Iterations(iterations);
  };
  add("bitset", index<BitsetContact>);
  add("byte_grid", byte_grid);
  add("kd_tree", index<KdTreeContact>);
}

}  // namespace

void register_all() {
  if (has_datasets()) register_for("intel", std::make_shared<const Points>(scene("intel").map()));
  for (const std::size_t n : {1'000U, 10'000U, 100'000U, 1'000'000U, 10'000'000U}) {
    register_for(std::to_string(n), std::make_shared<const Points>(walls(n)));
  }
}

}  // namespace glocal::bench
