#include "evaluation/sweeps/sweep.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <tuple>
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

/// A path below the localizer at which two runs have other values, if there is one.
std::optional<std::string> difference_of_methods(const std::map<std::string, Setting>& a,
                                                 const std::map<std::string, Setting>& b) {
  for (const auto& [path, setting] : a) {
    if (!path.starts_with("localizer.")) continue;
    const auto other = b.find(path);
    if (other == b.end() || other->second != setting) return path;
  }
  return std::nullopt;
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
  std::map<std::tuple<std::string, std::string, std::uint64_t>, std::string> seen;
  std::map<std::pair<std::string, std::string>, std::size_t> first_of;  // By setting and case.
  FaultCollector faults;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    faults.collect([&] {
      parts.push_back(sweep_run_of(runs, i));
      const RunPart& part = parts.back().part;
      const auto [other, is_new] =
          seen.try_emplace({part.setting, part.case_name, part.seed}, parts.back().name);
      if (!is_new)
        refuse_provenance(
            runs[i],
            fmt::format("is of the same setting, case and seed as {}; leave one of them out", other->second));
      const NamedRun& first = runs[first_of.try_emplace({part.setting, part.case_name}, i).first->second];
      if (const auto path = difference_of_methods(first.results.settings, runs[i].results.settings))
        refuse_provenance(runs[i],
                          fmt::format("has another {} than {}, and both are of the setting '{}'; leave "
                                      "one of them out",
                                      *path, first.name, part.setting));
    });
  }
  faults.report();
  return parts;
}

}  // namespace glocal
