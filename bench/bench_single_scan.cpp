// One scan, and nothing else known: where on the whole map was it made? How long the answer takes and how
// often the best guess is right, with the method `indexed` as it is.
//
// Changes are chosen on intel and office/1, and judged on the others.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench/scenes.hpp"
#include "cpu_time.hpp"
#include "evaluation/running/trials.hpp"
#include "sources/disturbed/surroundings.hpp"
#include "sources/ros_map/ros_map.hpp"
#include "sources/simulation/random_scans.hpp"
#include "sources/sites/office.hpp"

namespace glocal::bench {
namespace {

/// Maps, and scans made on them: each with its true pose.
struct Site {
  std::shared_ptr<const GlobalMap> map;
  std::vector<Sample> scans;
};

constexpr std::size_t seeds = 10;

/// A hundred scans for each seed, at random places of a map, as a clean laser sees it.
Site random_site(MapData data, double fov_deg) {
  simulation::RandomScans::Params params;
  params.laser.fov_deg = fov_deg;
  params.laser.step_deg = 1.0;
  params.laser.max_range = 12.0;
  Site site{std::make_shared<const GlobalMap>(std::move(data)), {}};
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    simulation::RandomScans source(params, site.map->data(), seed);
    while (auto sample = source.next()) site.scans.push_back(*std::move(sample));
  }
  return site;
}

Site ros_site(const std::string& file, double fov_deg = 360.0) {
  const std::string path = std::string(std::getenv("GLOCAL_DATASETS")) + "/maps/" + file;
  return random_site(ros_map::RosMap({.path = {.text = path, .resolved = path}}, {}).load(), fov_deg);
}

/// An office of 27 m on each side, with cells of 3 cm.
Site office_site(std::uint64_t number) {
  sites::OfficeMap::Params params;
  params.side = 27.0;
  params.number = number;
  params.resolution = 0.03;
  return random_site(sites::OfficeMap(params).load(), 360.0);
}

/// Scans of a recorded drive, 2 m apart, where other scans of it have made a map.
Site recorded_site(const std::string& case_name) {
  const Experiment experiment = read_experiment(
      {}, {{"name", "scene"}, {"methods", "indexed"}, {"cases", case_name}, {"trials.every_m", "2"}},
      catalog());
  const LoadedExperiment loaded = load_experiment(experiment, catalog(), [](const std::string&) {});
  Site site{loaded.map, {}};
  for (const std::size_t start : loaded.starts) site.scans.push_back(loaded.drive.samples[start]);
  return site;
}

/// The same scans, made among so many people within 8 m.
std::vector<Sample> among_people(const std::vector<Sample>& scans, int people) {
  std::vector<Sample> result;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    disturbed::People crowd(people, Rng(0));
    result.push_back(crowd.disturb(scans[i], Rng(1).stream({i})).value());
  }
  return result;
}

double quantile(std::vector<double> values, double share) {
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

/// CPU time, s.
template <class Work>
double cpu_time_of(Work work) {
  const std::int64_t start = cpu_time_ns();
  work();
  return 1e-9 * static_cast<double>(cpu_time_ns() - start);
}

/// Of the reference loop.
double reference_loop_time() {
  static const double time = [] {
    ReferenceLoop loop;
    std::vector<double> times;
    for (int i = 0; i < 15; ++i) times.push_back(cpu_time_of([&] { loop.run(); }));
    return quantile(times, 0.5);
  }();
  return time;
}

void single_scans(benchmark::State& state, const Site& site, int people) {
  const std::vector<Sample> scans = among_people(site.scans, people);
  const Experiment& experiment = scene("indexed", "paper_simulation").experiment;
  Localizer localizer(experiment.localizer, catalog(), {site.map, 1}, 1);
  std::vector<double> match, step;
  std::size_t right = 0;
  for ([[maybe_unused]] auto _ : state) {
    for (std::size_t i = 0; i < scans.size(); ++i) {
      localizer.reset(i);
      StepResult result;
      step.push_back(
          cpu_time_of([&] { result = waited_for(localizer, localizer.step(scans[i].observation)); }));
      match.push_back(1e-3 * (result.stage_cpu_ms.local_map + result.stage_cpu_ms.match));
      constexpr PoseTolerance near{.translation = 0.5, .rotation = radians(10.0)};
      if (!result.hypotheses.empty() &&
          near.are_near(result.hypotheses.front().map_from_robot, scans[i].map_from_robot.value()))
        ++right;
    }
  }
  state.counters["right"] = static_cast<double>(right) / static_cast<double>(match.size());
  state.counters["per_scan_median"] = quantile(match, 0.5);
  state.counters["per_scan_95"] = quantile(match, 0.95);
  state.counters["loops_median"] = quantile(match, 0.5) / reference_loop_time();
  state.counters["loops_95"] = quantile(match, 0.95) / reference_loop_time();
  state.counters["loops_step_median"] = quantile(step, 0.5) / reference_loop_time();
}

}  // namespace

/// With sites that are made when they are asked for, and kept.
void register_all() {
  const auto add = [](const std::string& name, const std::function<Site()>& make) {
    auto kept = std::make_shared<std::optional<Site>>();
    for (const int people : {0, 6}) {
      benchmark::RegisterBenchmark((name + "/people:" + std::to_string(people)).c_str(),
                                   [=](benchmark::State& state) {
                                     if (!*kept) *kept = make();
                                     single_scans(state, **kept, people);
                                   })
          ->Iterations(1)
          ->Unit(benchmark::kMillisecond);
    }
  };
  for (std::uint64_t number = 1; number <= seeds; ++number)
    add("office/" + std::to_string(number), [=] { return office_site(number); });
  if (!has_datasets()) return;
  add("intel", [] { return recorded_site("intel"); });
  add("fhw", [] { return recorded_site("fhw"); });
  add("willow", [] { return ros_site("willow_full/willow-full-0.05.yaml"); });
  add("willow_180", [] { return ros_site("willow_full/willow-full-0.05.yaml", 180.0); });
  add("depot", [] { return ros_site("nav2_depot/depot.yaml"); });
  add("depot_180", [] { return ros_site("nav2_depot/depot.yaml", 180.0); });
}

}  // namespace glocal::bench
