#include "evaluation/sweeps/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <tuple>

#include "evaluation/results/fault_collector.hpp"
#include "evaluation/results/json_text.hpp"
#include "glocal/error.hpp"

namespace glocal {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* part_key = "variant";

CaseRole role_of(const std::string& name) {
  constexpr std::array<CaseRole, 3> all = {CaseRole::none, CaseRole::choose, CaseRole::judge};
  const auto* const role =
      std::find_if(all.begin(), all.end(), [&](CaseRole r) { return name == to_string(r); });
  if (role == all.end()) throw std::invalid_argument("there is no role '" + name + "'");
  return *role;
}

SweepRun part_of(const NamedRun& run) {
  const Json& part = run.results.provenance.at(part_key);
  SweepRun result{.name = run.name,
                  .setting = part.at("setting"),
                  .case_name = part.at("case"),
                  .role = role_of(part.at("role")),
                  .seed = whole_number(part, "seed"),
                  .complete = run.results.complete,
                  .values = {},
                  .trials = &run.results.trials};
  for (const auto& [path, value] : part.at("values").items()) result.values.emplace_back(path, value);
  return result;
}

[[noreturn]] void refuse_run(const NamedRun& run, const std::string& what) {
  throw ConfigError({{(run.results.folder / "provenance.json").string(), 0, 0, what}});
}

SweepRun checked_part(const NamedRun& run, const std::string& experiment) {
  if (!run.results.provenance.contains(part_key))
    refuse_run(run,
               "does not say which setting these results are of; name a folder that glocal run has left "
               "of an experiment with variants, seeds or cases");
  if (run.results.experiment != experiment)
    refuse_run(run,
               fmt::format("is of the experiment {}, others are of {}; name the folder of one experiment",
                           run.results.experiment, experiment));
  try {
    return part_of(run);
  } catch (const std::exception& error) {
    refuse_run(run,
               fmt::format("is not as glocal run leaves it ({}); run the experiment again with this version",
                           reason(error)));
  }
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
  FaultCollector faults;
  for (const NamedRun& run : runs) {
    faults.collect([&] {
      parts.push_back(checked_part(run, runs.front().results.experiment));
      const SweepRun& part = parts.back();
      const auto [other, is_new] = seen.try_emplace({part.setting, part.case_name, part.seed}, part.name);
      if (!is_new)
        refuse_run(run, fmt::format("is of the same setting, case and seed as {}; leave one of them out",
                                    other->second));
    });
  }
  faults.report();
  return parts;
}

}  // namespace glocal
