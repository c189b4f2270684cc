#include "evaluation/comparison/named_runs.hpp"

#include <algorithm>
#include <set>

#include "config/nearest.hpp"
#include "evaluation/comparison/methods.hpp"
#include "evaluation/results/results_folder.hpp"
#include "glocal/error.hpp"

namespace glocal {
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

void for_each_results_folder(const std::vector<std::string>& paths, FaultCollector& faults,
                             const std::function<void(const fs::path&)>& work) {
  std::set<fs::path> seen;
  const auto hand_over = [&](const fs::path& folder) {
    if (!seen.insert(fs::canonical(folder)).second)
      throw ConfigError(folder, "is named twice; name each folder of results once");
    work(folder);
  };
  for (const std::string& path : paths) {
    faults.collect([&] {
      for (const fs::path& folder : results_folders(path)) faults.collect([&] { hand_over(folder); });
    });
  }
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

std::size_t find_baseline(const std::vector<NamedRun>& runs, const std::string& name) {
  if (name.empty()) return 0;
  const std::vector<Method> methods = methods_of(runs);
  for (const Method& method : methods) {
    if (method.name == name) return method.runs.front().index;
  }
  const auto only_index = [&](const auto& has_name) -> std::ptrdiff_t {
    const auto first = std::find_if(runs.begin(), runs.end(), has_name);
    if (first == runs.end() || std::find_if(first + 1, runs.end(), has_name) != runs.end()) return -1;
    return first - runs.begin();
  };
  std::ptrdiff_t index = only_index([&](const NamedRun& run) { return run.name == name; });
  if (index < 0) index = only_index([&](const NamedRun& run) { return run.results.experiment == name; });
  if (index >= 0) return static_cast<std::size_t>(index);
  std::vector<std::string> names;
  for (const Method& method : methods) names.push_back(method.name);
  throw ConfigError("--baseline " + name,
                    "names none, or more than one, of the methods" + suggestion(name, names, "there are"));
}

}  // namespace glocal
