#include "bench/scenes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <utility>
#include <vector>

#include "bench/plain.hpp"
#include "glocal/builtin.hpp"
#include "glocal/rng.hpp"

namespace glocal::bench {
namespace {

constexpr float tile_width = 26.16F;
constexpr float tile_height = 26.7F;
/// Of the reference loop.
constexpr std::size_t late_step = 110;
constexpr unsigned table_bits = 19;

Scene load(const std::string& file, const std::vector<Override>& overrides) {
  Scene scene;
  scene.experiment = read_experiment(file, overrides, catalog());
  scene.loaded = load_experiment(scene.experiment, catalog(), [](const std::string&) {});
  return scene;
}

const Scene& loaded_once(const std::string& name, const std::string& file,
                         const std::vector<Override>& overrides) {
  static std::map<std::string, Scene> scenes;
  const auto known = scenes.find(name);
  return known != scenes.end() ? known->second : scenes.emplace(name, load(file, overrides)).first->second;
}

/// Whether a copy of the map lacks what stands in this square metre.
bool is_missing(int copy, float x, float y) {
  const auto square =
      static_cast<std::uint64_t>(std::floor(x)) * 1000 + static_cast<std::uint64_t>(std::floor(y));
  return Rng(0).stream({static_cast<std::uint64_t>(copy), square}).uniform() < 0.3;
}

}  // namespace

const Catalog& catalog() {
  struct Filled : Catalog {
    Filled() { register_builtin_strategies(*this); }
  };
  static const Filled filled;
  return filled;
}

const Scene& scene(const std::string& name) {
  return loaded_once(name, GLOCAL_SOURCE_DIR "/configs/experiments/" + name + ".yaml", {});
}

const Scene& scene(const std::string& method, const std::string& case_name) {
  return loaded_once(method + "_" + case_name, {},
                     {{"name", "scene"}, {"methods", method}, {"cases", case_name}});
}

bool has_datasets() {
  return std::getenv("GLOCAL_DATASETS") != nullptr;
}

std::unique_ptr<Matcher> make_matcher(const Scene& scene, std::shared_ptr<const GlobalMap> map, int threads) {
  return catalog().matchers.make(scene.experiment.localizer.matcher, {std::move(map), threads});
}

LocalMap local_map_at(const Scene& scene, std::size_t start, std::size_t step) {
  const auto mapper =
      catalog().local_mappers.make(scene.experiment.localizer.local_mapper, {scene.loaded.map, 1});
  for (std::size_t i = start; i <= start + step; ++i) mapper->add(scene.loaded.drive.samples[i].observation);
  return mapper->map();
}

Pose2 true_map_from_local(const Scene& scene, std::size_t start, std::size_t step, const LocalMap& local) {
  return seen_from_above(scene.loaded.drive.samples[start + step].map_from_robot.value() *
                         inverse(local.local_from_robot));
}

std::shared_ptr<const GlobalMap> tiled_map(int n) {
  const Points& tile = simulation().map();
  MapData data;
  for (int copy = 0; copy < n * n; ++copy) {
    const int column = copy % n;
    const int row = copy / n;
    const float x0 = tile_width * static_cast<float>(column);
    const float y0 = tile_height * static_cast<float>(row);
    for (std::size_t i = 0; i < tile.size(); ++i) {
      if (copy > 0 && is_missing(copy, tile.x[i], tile.y[i])) continue;
      const float x = copy % 2 == 0 ? tile.x[i] : tile_width - tile.x[i];
      const float y = copy % 3 == 0 ? tile.y[i] : tile_height - tile.y[i];
      data.points.push_back({x0 + x, y0 + y, 0.0F});
    }
  }
  return std::make_shared<const GlobalMap>(std::move(data));
}

Points walls(std::size_t n) {
  // A wall of 4 m in each 4 m x 4 m square: 133 points.
  constexpr std::size_t points_per_wall = 133;
  const auto squares = static_cast<std::size_t>(
      std::ceil(std::sqrt(static_cast<double>(n) / static_cast<double>(points_per_wall))));
  Rng rng(1);
  Points points;
  points.reserve(n);
  for (std::size_t wall = 0; points.size() < n; ++wall) {
    const std::size_t column = wall % squares;
    const std::size_t row = wall / squares;
    const float x = 4.0F * static_cast<float>(column);
    const float y = 4.0F * static_cast<float>(row);
    const bool along_x = rng.below(2) == 0;
    for (std::size_t i = 0; i < points_per_wall && points.size() < n; ++i) {
      const float along = 0.03F * static_cast<float>(i);
      points.push_back({along_x ? x + along : x, along_x ? y : y + along, 0.0F});
    }
  }
  return points;
}

ReferenceLoop::ReferenceLoop()
    : local_(local_map_at(simulation(), 0, late_step)), table_(std::size_t{1} << table_bits) {}

void ReferenceLoop::run() {
  constexpr std::uint32_t iterations = 200'000;
  constexpr TriangleRule rule{.cell = 0.15, .min_side = 1.5, .min_height = 1.0};
  const Points& map = simulation().map();
  const auto entry = [&](Relation relation) -> std::uint64_t& {
    return table_[relation * std::uint64_t{0x9e3779b97f4a7c15} >> (64U - table_bits)];
  };
  std::size_t hits = 0;
  std::fill(table_.begin(), table_.end(), 0);
  for (std::uint32_t i = 0; i < iterations; ++i) {
    const auto triangle = plain::canonical_triangle(map, plain::draw(map, rng_), rule);
    if (triangle) entry(triangle->relation) = std::uint64_t{i} << 32U | triangle->relation;
  }
  for (std::uint32_t i = 0; i < iterations; ++i) {
    const auto triangle = plain::canonical_triangle(local_.points, plain::draw(local_.points, rng_), rule);
    if (triangle && static_cast<Relation>(entry(triangle->relation)) == triangle->relation) ++hits;
  }
  benchmark::DoNotOptimize(hits);
}

void reference_loop(benchmark::State& state) {
  ReferenceLoop loop;
  for ([[maybe_unused]] auto _ : state) loop.run();
}

}  // namespace glocal::bench
