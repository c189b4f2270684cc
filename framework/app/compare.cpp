// glocal compare: which of several runs on the same starts is better, and whether that can be told.
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "commands.hpp"
#include "config/nearest.hpp"
#include "results/atomic_file.hpp"
#include "results/comparison.hpp"
#include "results/comparison_report.hpp"
#include "results/comparison_writers.hpp"

namespace glocal::app {
namespace {

namespace fs = std::filesystem;

struct CompareOptions {
  std::vector<std::string> folders;
  std::string baseline;
  std::string csv, json, markdown;
  bool no_times = false;
  bool force = false;
};

/// The folder's own name, whatever way it was written.
std::string own_name(const fs::path& folder) {
  const fs::path path = fs::absolute(folder).lexically_normal();
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

/// Folders that are results, or hold some; every fault of all of them at once.
std::vector<NamedRun> read_runs(const std::vector<std::string>& folders) {
  std::vector<NamedRun> runs;
  std::vector<Fault> faults;
  std::set<fs::path> seen;
  const auto read = [&](const fs::path& folder) {
    if (!seen.insert(fs::canonical(folder)).second)
      throw ConfigError({{folder.string(), 0, 0, "is named twice; name each folder of results once"}});
    runs.push_back({own_name(folder), read_results(folder)});
  };
  const auto collect = [&](const auto& work) {
    try {
      work();
    } catch (const ConfigError& error) {
      faults.insert(faults.end(), error.faults().begin(), error.faults().end());
    }
  };
  for (const std::string& path : folders) {
    collect([&] {
      for (const fs::path& folder : results_folders(path)) collect([&] { read(folder); });
    });
  }
  if (!faults.empty()) throw ConfigError(std::move(faults));
  if (runs.size() < 2) {
    throw ConfigError({{folders.front(), 0, 0,
                        "there is nothing to compare it with; name two folders of results or more"}});
  }
  return runs;
}

/// Folders of one name go by their paths.
void tell_apart(std::vector<NamedRun>& runs) {
  std::multiset<std::string> names;
  for (const NamedRun& run : runs) names.insert(run.name);
  for (NamedRun& run : runs) {
    if (names.count(run.name) > 1) run.name = run.results.folder.string();
  }
}

/// The run with that name, or the only one of the experiment with that name.
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

std::string json_text(const Comparison& comparison) {
  // Names of folders need not be UTF-8.
  return to_json(comparison).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

void compare_runs(const CompareOptions& options) {
  std::vector<NamedRun> runs = read_runs(options.folders);
  tell_apart(runs);
  const Comparison comparison = compare(runs, find_baseline(runs, options.baseline),
                                        options.no_times ? measures_but_time() : measures());
  AtomicFiles files(options.force);
  if (!options.csv.empty()) files.add(options.csv, to_csv(comparison));
  if (!options.json.empty()) files.add(options.json, json_text(comparison));
  if (!options.markdown.empty()) files.add(options.markdown, markdown_report(comparison));
  files.commit();
  fmt::print("{}", text_report(comparison));
}

}  // namespace

void add_compare(CLI::App& app, Context& /*context*/) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* command =
      app.add_subcommand("compare", "Compare runs on the same starts, with tests of what differs.");
  command->add_option("DIR", options->folders, "Folders of results, or folders that hold some")->required();
  command->add_option("--baseline", options->baseline,
                      "Run to compare with, by the name of its folder or experiment (default: the first)");
  command->add_option("--csv", options->csv, "Write a row for each variant and test");
  command->add_option("--json", options->json, "Write everything");
  command->add_option("--markdown", options->markdown, "Write the report as Markdown");
  command->add_flag("--no-times", options->no_times, "Leave times out, which no two runs have in common");
  command->add_flag("--force", options->force, "Replace files that exist");
  command->callback([options] { compare_runs(*options); });
}

}  // namespace glocal::app
