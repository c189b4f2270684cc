#include "evaluation/running/experiment_runner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "config/nearest.hpp"
#include "evaluation/results/fault_collector.hpp"
#include "evaluation/results/file_io.hpp"
#include "evaluation/results/map_files.hpp"
#include "evaluation/results/output_folder.hpp"
#include "evaluation/results/run_results.hpp"
#include "evaluation/results/variant_order.hpp"
#include "evaluation/running/elapsed.hpp"
#include "evaluation/running/others_load.hpp"
#include "glocal/error.hpp"

namespace glocal {
namespace {

using Json = nlohmann::ordered_json;

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
bool is_unfinished(const std::filesystem::path& folder, bool is_final) {
  if (std::filesystem::exists(folder / journal_folder)) return true;
  const std::optional<bool> complete = is_complete(folder);
  return is_final ? complete == false : complete.has_value();
}

}  // namespace

VariantResult result_of_variant(const std::string& name, const std::filesystem::path& folder,
                                const Json& summary) {
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

ExperimentRunner::ExperimentRunner(std::vector<Variant> variants, const std::filesystem::path& file,
                                   const Catalog& catalog, RunOptions options, RunnerCallbacks callbacks)
    : variants_(std::move(variants)),
      file_(file.empty() ? file : std::filesystem::absolute(file)),
      catalog_(catalog),
      options_(std::move(options)),
      callbacks_(std::move(callbacks)),
      out_(options_.out.empty() ? std::filesystem::path("results") / variants_.front().experiment.name
                                : options_.out),
      loader_(catalog, callbacks_.warn, callbacks_.progress) {}

RunResult ExperimentRunner::run() {
  const std::vector<std::string> all_names = names_of(variants_);
  select();
  const std::vector<std::string> names = names_of(variants_);
  const bool has_variants = !names.front().empty();
  if (has_variants) take_finished();
  check_outputs();
  note_trials();
  std::size_t trials = 0;
  for (const std::size_t n : count_trials(variants_, loader_, catalog_)) trials += n;
  callbacks_.counted(trials);
  const std::size_t kept = results_.size();
  for (const std::size_t i : loading_order(variants_, catalog_)) {
    if (callbacks_.trials.stop() && results_.size() > kept) break;
    run_one(variants_[i]);
  }
  if (has_variants && !results_.empty()) write_variant_order(out_, all_names);
  const auto place = [&](const VariantResult& r) { return std::find(names.begin(), names.end(), r.name); };
  std::sort(results_.begin(), results_.end(),
            [&](const VariantResult& a, const VariantResult& b) { return place(a) < place(b); });
  const bool complete =
      results_.size() == names.size() &&
      std::all_of(results_.begin(), results_.end(), [](const VariantResult& r) { return r.complete; });
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
    const std::filesystem::path folder = folder_of(variant.name);
    if (!is_results_folder(folder)) return false;
    const auto why = why_other(folder, variant);
    if (why && !options_.force) {
      faults.add({folder.string(), 0, 0,
                  fmt::format("output: the folder has results of another run: {}; choose another folder "
                              "with --out, or replace earlier results with --force",
                              *why)});
    }
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

/// What is wrong with the folders is said before anything is computed.
void ExperimentRunner::check_outputs() {
  FaultCollector faults;
  for (Variant& variant : variants_) {
    faults.collect([&] {
      OutputFolder::check(folder_of(variant.name), options_.force,
                          [&](const std::filesystem::path& earlier, bool is_final) {
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

std::optional<std::string> ExperimentRunner::why_other(const std::filesystem::path& folder,
                                                       Variant& variant) {
  return why_other_run(folder, effective_yaml(variant.experiment, catalog_), origin_json(variant), file_,
                       hashes_);
}

void ExperimentRunner::run_one(Variant& variant) {
  Experiment& experiment = variant.experiment;
  LoadedExperiment& loaded = loader_.load(experiment);
  if (!file_.empty()) loaded.inputs.insert(file_);
  loaded.inputs.insert(options_.plugins.begin(), options_.plugins.end());
  const auto start = std::chrono::steady_clock::now();
  std::vector<Localizer> localizers;
  localizers.push_back(make_localizer(experiment, catalog_, loaded));
  const double map_index_ms = ms_since(start);
  if (const auto why = why_never_declared(experiment, loaded, localizers.front())) callbacks_.warn(*why);

  // Nothing is written before everything is known to be in order.
  std::optional<std::string> declined;
  const auto takes_up = [&](const std::filesystem::path& earlier, bool is_final) {
    if (!is_unfinished(earlier, is_final)) return false;
    declined = why_other(earlier, variant);
    return !declined;
  };
  OutputFolder folder(folder_of(variant.name), options_.force, takes_up);
  if (declined)
    callbacks_.warn(
        fmt::format("{}: starts afresh: what an earlier run has left unfinished is dropped, as {}",
                    folder.path().string(), *declined));
  if (is_complete(folder.unfinished()) == true) {
    begin(variant, folder, loaded, loaded.starts.size());
    put_in_place(folder, variant.name, Json::parse(content_of(folder.unfinished() / "summary.json")));
    return;
  }
  RunResults results(folder, experiment.output, loaded.starts.size(), callbacks_.warn);
  const std::size_t trials = loaded.starts.size();
  write_origin(folder, variant, loaded);
  begin(variant, folder, loaded, trials - results.to_run().size());

  while (localizers.size() <
         std::min(static_cast<std::size_t>(std::max(options_.jobs, 1)), results.to_run().size()))
    localizers.push_back(make_localizer(experiment, catalog_, loaded));
  const auto on_step = [&](std::size_t trial, const StepRecord& record, const Localizer& now) {
    const Sample& sample = loaded.drive.samples[loaded.starts[trial] + record.result.step];
    results.step(trial, record, sample.observation.scan, now);
    callbacks_.trials.step(trial, record, now);
  };
  const auto on_done = [&](const TrialRecord& record) {
    results.finish(record);
    callbacks_.trials.done(record);
  };
  const OthersLoad others_load;
  const bool complete = run_trials(localizers, experiment, loaded, results.to_run(),
                                   {on_step, on_done, callbacks_.trials.stop});

  const Json summary = results.put_together().to_json(
      {experiment.name, experiment.seed, complete, loaded.map->points().size(), loaded.map_build_ms,
       map_index_ms, localizers.front().map_index(), peak_rss_mb(), others_load.mean()});
  // The summary comes last: a later run takes its word that all is there.
  folder.write_for_good("summary.json", summary.dump(2) + "\n");
  put_in_place(folder, variant.name, summary);
  if (!complete)
    callbacks_.warn(
        fmt::format("interrupted: {} of {} trials were finished and kept", results_.back().trials, trials));
}

/// What tells which run this is.
void ExperimentRunner::write_origin(OutputFolder& folder, Variant& variant, const LoadedExperiment& loaded) {
  Experiment& experiment = variant.experiment;
  folder.write("effective.yaml", effective_yaml(experiment, catalog_, *loaded.map));
  const Json origin = provenance_of_run(catalog_, variant, options_, loaded.inputs, hashes_);
  // Names of files need not be UTF-8.
  folder.write("provenance.json", origin.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  if (experiment.output.maps == "none") return;
  for (const auto& [name, content] : map_files(*loaded.map)) folder.write(name, content);
}

void ExperimentRunner::begin(const Variant& variant, const OutputFolder& folder,
                             const LoadedExperiment& loaded, std::size_t finished) {
  if (finished > 0)
    callbacks_.note(fmt::format("{}: goes on where an earlier run has stopped: {} of {} trials are finished",
                                folder.path().string(), finished, loaded.starts.size()));
  std::map<std::string, std::string> inputs;
  for (const std::filesystem::path& input : loaded.inputs) inputs[input.string()] = hashes_.of(input);
  callbacks_.begin({variant.name, folder.path(), variant.experiment, loaded,
                    read_settings(folder.unfinished(), inputs), finished});
}

void ExperimentRunner::put_in_place(OutputFolder& folder, const std::string& variant, const Json& summary) {
  if (summary.at("complete")) std::filesystem::remove_all(folder.unfinished() / journal_folder);
  folder.commit();
  add_result(variant, summary);
}

}  // namespace glocal
