#include "evaluation/running/experiment_runner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "config/nearest.hpp"
#include "evaluation/results/fault_collector.hpp"
#include "evaluation/results/file_io.hpp"
#include "evaluation/results/map_files.hpp"
#include "evaluation/results/output_folder.hpp"
#include "evaluation/results/run_results.hpp"
#include "evaluation/results/summary.hpp"
#include "evaluation/results/variant_order.hpp"
#include "evaluation/running/others_load.hpp"
#include "evaluation/sharding/manifest.hpp"
#include "glocal/error.hpp"

namespace glocal {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Where a results folder has the journals of processes, until all trials have come to an end.
constexpr const char* journal_folder = "journal";

std::vector<std::string> names_of(const std::vector<Variant>& variants) {
  std::vector<std::string> names;
  for (const Variant& variant : variants) names.push_back(variant.name);
  return names;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Whether an earlier run has left something to go on with. A folder in its place is one of a finished run,
/// unless it says otherwise.
bool is_unfinished(const fs::path& folder, bool is_final) {
  if (fs::exists(folder / journal_folder)) return true;
  const std::optional<bool> complete = is_complete(folder);
  return is_final ? complete == false : complete.has_value();
}

Fault results_of_another_run(const fs::path& folder, const std::string& why) {
  return {folder.string(), 0, 0,
          fmt::format("output: the folder has results of another run: {}; choose another folder with --out, "
                      "or replace earlier results with --force",
                      why)};
}

}  // namespace

VariantResult result_of_variant(const std::string& name, const fs::path& folder, const Json& summary) {
  const Json& trials = summary.at("trials");
  return {.name = name,
          .folder = folder,
          .summary = folder / "summary.json",
          .complete = summary.at("complete"),
          .trials = trials.at("count"),
          .right = trials.at("right"),
          .wrong = trials.at("wrong"),
          .undecided = trials.at("undecided"),
          .declared = trials.value("declared_without_reference", std::size_t{0}),
          .failed = trials.value("failed", std::size_t{0})};
}

ExperimentRunner::ExperimentRunner(std::vector<Variant> variants, const fs::path& file,
                                   const Catalog& catalog, RunOptions options, RunnerCallbacks callbacks)
    : variants_(std::move(variants)),
      file_(file.empty() ? file : fs::absolute(file)),
      catalog_(catalog),
      options_(std::move(options)),
      callbacks_(std::move(callbacks)),
      out_(options_.out.empty() ? fs::path("results") / variants_.front().experiment.name : options_.out),
      loader_(catalog, callbacks_.warn, callbacks_.progress) {
  options_.jobs = std::max(options_.jobs, 1);
  for (const auto& [source, hash] : options_.sources) {
    loader_.hashes().tell(source, hash);
    if (source != file_) options_.plugins.emplace_back(source);
  }
}

RunResult ExperimentRunner::run() {
  const std::vector<std::string> all_names = names_of(variants_);
  select();
  const std::vector<std::string> names = names_of(variants_);
  const bool has_variants = !names.front().empty();
  if (has_variants) {
    take_finished();
    warn_of_others(all_names);
  }
  check_outputs();
  note_trials();
  std::size_t trials = 0;
  for (const std::size_t n : count_trials(variants_, loader_)) trials += n;
  callbacks_.counted(trials);
  const std::size_t kept = results_.size();
  for (const std::size_t i : loading_order(variants_, catalog_)) {
    if (callbacks_.trials.stop() && results_.size() > kept) break;
    run_one(variants_[i]);
  }
  if (has_variants && !results_.empty()) write_variant_order(out_, all_names);
  std::ranges::sort(results_, {}, [&](const VariantResult& r) { return std::ranges::find(names, r.name); });
  const bool complete =
      results_.size() == names.size() && std::ranges::all_of(results_, &VariantResult::complete);
  return {out_, std::move(results_), complete};
}

/// Keeps the variants that are named, in the order of the file.
void ExperimentRunner::select() {
  std::vector<std::string> names = names_of(variants_);
  std::erase(names, "");
  std::vector<Fault> faults;
  for (const std::string& name : options_.only) {
    if (contains(names, name)) continue;
    const std::string help =
        names.empty() ? " (the experiment has no variants)" : suggestion(name, names, "there are");
    faults.push_back({"--only " + name, 0, 0, "no such variant" + help});
  }
  if (!faults.empty()) throw ConfigError(std::move(faults));
  if (options_.only.empty()) return;
  std::erase_if(variants_, [&](const Variant& variant) { return !contains(options_.only, variant.name); });
}

/// The variants that an earlier run has finished need not be run. Throws ConfigError for results of other
/// runs that are in the way, and for damaged ones.
void ExperimentRunner::take_finished() {
  FaultCollector faults;
  if (is_results_folder(out_)) {
    faults.add({out_.string(), 0, 0,
                "output: the folder has results of a run without variants; choose another one with --out"});
  }
  std::erase_if(variants_, [&](Variant& variant) {
    const fs::path folder = folder_of(variant.name);
    if (!is_results_folder(folder)) return false;
    const auto why = why_other(folder, variant);
    if (why && !options_.force) faults.add(results_of_another_run(folder, *why));
    if (why || is_unfinished(folder, true)) return false;
    FaultCollector damage;
    const bool is_whole = damage.collect([&] { add_result(variant.name, read_results(folder).summary); });
    if (!is_whole && !options_.force) faults.collect([&] { damage.report(); });
    if (!is_whole) return false;
    faults.collect([&] { OutputFolder::tidy(folder); });
    callbacks_.note(fmt::format("{}: kept, as an earlier run has finished it", variant.name));
    return true;
  });
  faults.report();
}

/// Whoever compares what is in the folder counts variants, too, that the file has no longer.
void ExperimentRunner::warn_of_others(const std::vector<std::string>& names) const {
  std::vector<std::string> others;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(out_, none)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with('.') && !contains(names, name) && is_results_folder(entry.path()))
      others.push_back(name);
  }
  std::ranges::sort(others);
  for (const std::string& name : others)
    callbacks_.warn(fmt::format(
        "{}: results of a variant that is not in the file: compare, sweep and report count it; remove it if "
        "that is not meant",
        (out_ / name).string()));
}

/// What is wrong with the folders is said before anything is computed.
void ExperimentRunner::check_outputs() {
  FaultCollector faults;
  for (Variant& variant : variants_) {
    faults.collect([&] {
      const fs::path interrupted = folder_of(variant.name);
      if (!options_.force && is_results_folder(interrupted) && is_unfinished(interrupted, true)) {
        if (const auto why = why_other(interrupted, variant))
          throw ConfigError({results_of_another_run(interrupted, *why)});
      }
      OutputFolder::check(folder_of(variant.name), options_.force,
                          [&](const fs::path& earlier, bool is_final) {
                            return is_unfinished(earlier, is_final) && !why_other(earlier, variant);
                          });
    });
  }
  faults.report();
}

void ExperimentRunner::note_trials() const {
  for (const Variant& variant : variants_) {
    if (variant.changes_trials)
      callbacks_.note(
          fmt::format("{}: has a seed, a map, observations or trials of its own: other starts or other noise",
                      variant.name));
  }
}

std::optional<std::string> ExperimentRunner::why_other(const fs::path& folder, Variant& variant) {
  return why_other_run(folder, effective_yaml(variant.experiment, catalog_), origin_json(variant), file_,
                       options_.plugins, loader_.hashes());
}

void ExperimentRunner::run_one(Variant& variant) {
  VariantRun run(variant, loader_, file_, options_);
  if (const auto why = why_never_declared(variant.experiment, run.loaded(), run.localizer()))
    callbacks_.warn(*why);

  // Nothing is written before everything is known to be in order.
  std::optional<std::string> declined;
  const auto takes_up = [&](const fs::path& earlier, bool is_final) {
    if (!is_unfinished(earlier, is_final)) return false;
    declined = why_other(earlier, variant);
    return !declined;
  };
  OutputFolder folder(folder_of(variant.name), options_.force, run.inputs(), takes_up);
  if (declined)
    callbacks_.warn(
        fmt::format("{}: starts afresh: what an earlier run has left unfinished is dropped, as {}",
                    folder.path().string(), *declined));
  if (is_complete(folder.unfinished()) == true) {
    begin(variant, folder, run, run.loaded().starts.size());
    put_in_place(folder, variant.name, Json::parse(content_of(folder.unfinished() / "summary.json")));
    return;
  }
  const std::string identity =
      identity_of(variant.experiment, run.loaded().inputs, options_.plugins, loader_);
  const fs::path journals = folder.unfinished() / journal_folder;
  JournalScan scan(journals, callbacks_.warn);
  const JournaledTrials trials(scan, identity, run.loaded().starts);
  const std::vector<std::size_t> to_run = trials.missing();
  Json description = run.description();
  trials.tell_processes(description.at("provenance"));
  write_origin(folder, description);
  if (variant.experiment.output.maps != "none") {
    for (const auto& [name, content] : map_files(*run.loaded().map)) folder.write(name, content);
  }
  // Without these nobody could tell whose trials the journal has.
  folder.sync();
  begin(variant, folder, run, trials.count() - to_run.size());

  RunCallbacks callbacks = callbacks_.trials;
  callbacks.done = [&](const TrialRecord& record) {
    folder.keep_unfinished();
    callbacks_.trials.done(record);
  };
  const OthersLoad others_load;
  Journal journal(journals, {}, options_.jobs);
  const bool complete = run.run(identity, to_run, journal, callbacks, false);
  journal.close();
  scan.update();
  description["peak_rss_mb"] = peak_rss_mb();
  // What others did while an earlier process ran the first trials, nobody knows.
  const auto mean = to_run.size() == trials.count() ? others_load.mean() : std::nullopt;
  if (mean) description["others_load"] = *mean;
  put_in_place(folder, variant.name, put_together(folder, description, trials, complete));
  if (!complete)
    callbacks_.warn(fmt::format("interrupted: {} of {} trials were finished and kept", results_.back().trials,
                                trials.count()));
}

void ExperimentRunner::begin(const Variant& variant, const OutputFolder& folder, const VariantRun& run,
                             std::size_t finished) {
  if (finished > 0)
    callbacks_.note(fmt::format("{}: goes on where an earlier run has stopped: {} of {} trials are finished",
                                folder.path().string(), finished, run.loaded().starts.size()));
  std::map<std::string, std::string> inputs;
  for (const fs::path& input : run.inputs()) inputs[input.string()] = loader_.hashes().of(input);
  callbacks_.begin({variant.name, folder.path(), variant.experiment, run.loaded(),
                    read_settings(folder.unfinished(), inputs), finished});
}

void ExperimentRunner::put_in_place(OutputFolder& folder, const std::string& variant, const Json& summary) {
  if (summary.at("complete")) fs::remove_all(folder.unfinished() / journal_folder);
  folder.commit();
  add_result(variant, summary);
}

}  // namespace glocal
