#include "evaluation/sweeps/sweep.hpp"

#include <fmt/format.h>

#include <utility>

#include "evaluation/results/fault_collector.hpp"
#include "glocal/error.hpp"

namespace glocal {
namespace {

SweepRun sweep_run_of(const std::vector<NamedRun>& runs, std::size_t index) {
  const NamedRun& run = runs[index];
  const std::string& experiment = runs.front().results.experiment;
  auto part = part_of(run);
  if (!part)
    refuse_provenance(
        run,
        "does not say which setting these results are of; name a folder that glocal run has left "
        "of an experiment with methods, variants, seeds or cases");
  if (run.results.experiment != experiment)
    refuse_provenance(
        run, fmt::format("is of the experiment {}, others are of {}; name the folder of one experiment",
                         run.results.experiment, experiment));
  return {.index = index,
          .name = run.name,
          .part = *std::move(part),
          .complete = run.results.complete,
          .effective = &run.results.settings,
          .trials = &run.results.trials};
}

}  // namespace

bool is_sweep(const std::vector<NamedRun>& runs) {
  try {
    static_cast<void>(sweep_of(runs));
    return true;
  } catch (const ConfigError&) {
    return false;
  }
}

std::vector<SweepRun> sweep_of(const std::vector<NamedRun>& runs) {
  std::vector<SweepRun> parts;
  PooledParts pooled;
  FaultCollector faults;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    faults.collect([&] {
      parts.push_back(sweep_run_of(runs, i));
      pooled.add({}, parts.back().part, runs[i]);
    });
  }
  faults.report();
  return parts;
}

}  // namespace glocal
