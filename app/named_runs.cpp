#include "app/named_runs.hpp"

#include <algorithm>
#include <set>

#include "app/results_arguments.hpp"
#include "app/results_at_hand.hpp"
#include "config/nearest.hpp"

namespace glocal::app {
namespace {

namespace fs = std::filesystem;

/// Folders of one name go by their paths.
void tell_apart(std::vector<NamedRun>& runs) {
  std::multiset<std::string> names;
  for (const NamedRun& run : runs) names.insert(run.name);
  for (NamedRun& run : runs) {
    if (names.count(run.name) > 1) run.name = run.results.folder.string();
  }
}

}  // namespace

std::string own_name(const fs::path& folder) {
  const fs::path path = fs::absolute(folder).lexically_normal();
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

std::vector<NamedRun> read_runs(const std::vector<std::string>& folders,
                                const std::function<StoredRun(const fs::path&)>& read) {
  std::vector<NamedRun> runs;
  FaultCollector faults;
  for_each_results_folder(folders, faults, [&](const fs::path& folder) {
    runs.push_back({own_name(folder), read(folder)});
  });
  faults.report();
  tell_apart(runs);
  return runs;
}

std::vector<NamedRun> read_sweep(const std::string& folder) {
  const ResultsAtHand results({folder});
  return read_runs(results.folders(),
                   [](const fs::path& run) { return read_results(run, {}, ResultParts::all_but_steps); });
}

std::size_t find_baseline(const std::vector<NamedRun>& runs, const std::string& name) {
  if (name.empty()) return 0;
  const auto only_index = [&](const auto& has_name) -> std::ptrdiff_t {
    const auto first = std::find_if(runs.begin(), runs.end(), has_name);
    if (first == runs.end() || std::find_if(first + 1, runs.end(), has_name) != runs.end()) return -1;
    return first - runs.begin();
  };
  std::ptrdiff_t index = only_index([&](const NamedRun& run) { return run.name == name; });
  if (index < 0) index = only_index([&](const NamedRun& run) { return run.results.experiment == name; });
  if (index >= 0) return static_cast<std::size_t>(index);
  std::vector<std::string> names;
  for (const NamedRun& run : runs) names.push_back(run.name);
  throw ConfigError({{"--baseline " + name, 0, 0,
                      "names none, or more than one, of the runs" + suggestion(name, names, "there are")}});
}

}  // namespace glocal::app
