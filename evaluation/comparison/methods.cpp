#include "evaluation/comparison/methods.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "evaluation/comparison/named_runs.hpp"
#include "evaluation/comparison/run_part.hpp"
#include "evaluation/results/fault_collector.hpp"
#include "glocal/error.hpp"

namespace glocal {
namespace {

namespace fs = std::filesystem;

/// The folder that holds those of an experiment's parts.
fs::path folder_of_experiment(const NamedRun& run) {
  return (fs::absolute(run.results.folder) / "").lexically_normal().parent_path().parent_path();
}

/// Methods of one name go by the folders of their experiments.
void tell_methods_apart(const std::vector<NamedRun>& runs, std::vector<Method>& methods) {
  const auto rename_equal = [&](const auto& name_in) {
    std::multiset<std::string> names;
    for (const Method& method : methods) names.insert(method.name);
    std::vector<std::string> renamed;
    for (const Method& method : methods) {
      const fs::path folder = folder_of_experiment(runs[method.runs.front().index]);
      renamed.push_back(names.count(method.name) > 1 ? name_in(folder, method.name) : method.name);
    }
    const std::set<std::string> different(renamed.begin(), renamed.end());
    if (different.size() < methods.size()) return false;
    for (std::size_t i = 0; i < methods.size(); ++i) methods[i].name = renamed[i];
    return true;
  };
  if (rename_equal([](const fs::path& folder, const std::string& name) {
        return folder.filename().string() + "/" + name;
      }))
    return;
  rename_equal([](const fs::path& folder, const std::string& name) { return (folder / name).string(); });
}

using CellKey = std::pair<std::size_t, std::uint64_t>;                     ///< Number of the case, and seed.
using RunsByCell = std::map<CellKey, std::map<std::size_t, std::size_t>>;  ///< Of each method its run.

/// "intel with seeds 1, 2"; without seeds where any will do.
std::string cell_words(const std::string& case_name, const std::vector<std::string>& seeds) {
  std::string name = case_name.empty() ? "runs without a case" : case_name;
  if (seeds.empty()) return name;
  return fmt::format("{} with {} {}", name, seeds.size() == 1 ? "seed" : "seeds", fmt::join(seeds, ", "));
}

/// By case and by the methods that have it.
std::vector<std::string> words_of_left_out(const RunsByCell& cells, bool is_any_seed,
                                           const std::vector<std::string>& cases,
                                           const std::vector<Method>& methods) {
  std::map<std::pair<std::size_t, std::vector<std::string>>, std::vector<std::string>> seeds;
  for (const auto& [key, runs] : cells) {
    if (runs.size() == methods.size()) continue;
    std::vector<std::string> names;
    for (const auto& [method, run] : runs) names.push_back(methods[method].name);
    std::vector<std::string>& list = seeds[{key.first, names}];
    if (!is_any_seed) list.push_back(std::to_string(key.second));
  }
  std::vector<std::string> words;
  for (const auto& [key, list] : seeds)
    words.push_back(
        fmt::format("{} (only {})", cell_words(cases[key.first], list), fmt::join(key.second, ", ")));
  return words;
}

[[noreturn]] void refuse_without_common_cell(const std::vector<NamedRun>& runs,
                                             const std::vector<Method>& methods) {
  std::vector<Fault> faults;
  for (const Method& method : methods) {
    std::map<std::string, std::vector<std::string>> seeds;
    for (const Method::Run& run : method.runs) seeds[run.case_name].push_back(std::to_string(run.seed));
    std::vector<std::string> words;
    for (const auto& [name, list] : seeds) words.push_back(cell_words(name, list));
    faults.push_back({runs[method.runs.front().index].results.folder.string(), 0, 0,
                      fmt::format("{} was run on {}: not one case and seed is one of all methods; run all of "
                                  "them with the same cases and seeds",
                                  method.name, fmt::join(words, "; "))});
  }
  throw ConfigError(std::move(faults));
}

[[noreturn]] void refuse_without_common_start(const std::vector<NamedRun>& runs,
                                              const std::vector<PairedTrials::Cell>& cells) {
  std::vector<Fault> faults;
  for (const PairedTrials::Cell& cell : cells) {
    for (const std::size_t run : cell.runs)
      faults.push_back({runs[run].results.folder.string(), 0, 0,
                        fmt::format("none of its {} starts is one of all runs to compare; run all "
                                    "experiments with the same observations and trials",
                                    runs[run].results.trials.size())});
  }
  throw ConfigError(std::move(faults));
}

bool has_one_seed_a_case(const Method& method) {
  std::set<std::string> cases;
  for (const Method::Run& run : method.runs) cases.insert(run.case_name);
  return cases.size() == method.runs.size();
}

/// Adds the trials of a cell that all methods have.
void add_shared_trials(const std::vector<NamedRun>& runs, std::size_t number, PairedTrials& paired) {
  const std::vector<std::size_t>& of_methods = paired.cells[number].runs;
  std::vector<const TrialResult*> found(of_methods.size());
  for (const auto& [start, first] : runs[of_methods.front()].results.trials) {
    found.front() = &first;
    bool is_shared = true;
    for (std::size_t m = 1; m < of_methods.size() && is_shared; ++m) {
      const auto& trials = runs[of_methods[m]].results.trials;
      const auto other = trials.find(start);
      is_shared = other != trials.end();
      if (is_shared) found[m] = &other->second;
    }
    if (!is_shared) continue;
    paired.trials.push_back({number, start});
    for (std::size_t m = 0; m < found.size(); ++m) paired.results[m].push_back(found[m]);
  }
}

/// Puts trials of one place beside each other.
void sort_by_place(PairedTrials& paired) {
  const auto place_of = [&](std::size_t trial) {
    const auto& [cell, start] = paired.trials[trial];
    return std::pair(paired.cells[cell].case_number, start.sample);
  };
  std::vector<std::size_t> order(paired.trials.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(order, {}, place_of);
  const auto reorder = [&](auto& list) {
    auto sorted = list;
    for (std::size_t i = 0; i < order.size(); ++i) sorted[i] = list[order[i]];
    list = std::move(sorted);
  };
  reorder(paired.trials);
  for (auto& results : paired.results) reorder(results);
  for (std::size_t i = 0; i < paired.trials.size(); ++i) {
    const auto [case_number, sample] = place_of(i);
    if (paired.places.empty() || std::pair(paired.places.back().case_number, paired.places.back().sample) !=
                                     std::pair(case_number, sample))
      paired.places.push_back({case_number, sample, i, i});
    paired.places.back().end = i + 1;
  }
}

}  // namespace

std::vector<Method> methods_of(const std::vector<NamedRun>& runs) {
  std::vector<Method> methods;
  std::map<std::pair<fs::path, std::string>, std::size_t> numbers;
  PooledParts pooled;
  FaultCollector faults;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    faults.collect([&] {
      const auto part = part_of(runs[i]);
      if (!part) {
        methods.push_back({runs[i].name, {{"", runs[i].results.seed, i}}});
        return;
      }
      const fs::path folder = folder_of_experiment(runs[i]);
      pooled.add(folder, *part, runs[i]);
      const auto [number, is_new] = numbers.try_emplace({folder, part->setting}, methods.size());
      if (is_new) methods.push_back({part->setting.empty() ? runs[i].results.experiment : part->setting, {}});
      methods[number->second].runs.push_back({part->case_name, part->seed, i});
    });
  }
  faults.report();
  tell_methods_apart(runs, methods);
  return methods;
}

PairedTrials pair_trials(const std::vector<NamedRun>& runs, const std::vector<Method>& methods) {
  PairedTrials paired;
  const bool is_any_seed = std::all_of(methods.begin(), methods.end(), has_one_seed_a_case);
  RunsByCell cells;
  for (std::size_t m = 0; m < methods.size(); ++m) {
    for (const Method::Run& run : methods[m].runs) {
      const auto known = std::find(paired.cases.begin(), paired.cases.end(), run.case_name);
      const auto case_number = static_cast<std::size_t>(known - paired.cases.begin());
      if (known == paired.cases.end()) paired.cases.push_back(run.case_name);
      cells[{case_number, is_any_seed ? 0 : run.seed}][m] = run.index;
    }
  }
  for (const auto& [key, of_methods] : cells) {
    if (of_methods.size() < methods.size()) continue;
    PairedTrials::Cell cell{key.first, runs[of_methods.at(0)].results.seed, {}};
    for (const auto& [method, run] : of_methods) cell.runs.push_back(run);
    paired.cells.push_back(std::move(cell));
  }
  paired.left_out = words_of_left_out(cells, is_any_seed, paired.cases, methods);
  paired.results.resize(methods.size());
  for (std::size_t cell = 0; cell < paired.cells.size(); ++cell) add_shared_trials(runs, cell, paired);
  sort_by_place(paired);
  return paired;
}

void refuse_unpaired(const std::vector<NamedRun>& runs, const std::vector<Method>& methods,
                     const PairedTrials& paired) {
  if (paired.cells.empty()) refuse_without_common_cell(runs, methods);
  refuse_without_common_start(runs, paired.cells);
}

}  // namespace glocal
