// glocal run: runs an experiment, or each of its variants, and leaves results in folders.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/commands.hpp"
#include "app/experiment_options.hpp"
#include "app/progress.hpp"
#include "app/run_report.hpp"
#include "app/watch_server.hpp"
#include "config/nearest.hpp"
#include "evaluation/results/output_folder.hpp"
#include "evaluation/results/pcd.hpp"
#include "evaluation/results/provenance.hpp"
#include "evaluation/results/results_folder.hpp"
#include "evaluation/results/run_results.hpp"
#include "evaluation/running/experiment_loader.hpp"
#include "glocal/experiment.hpp"
#include "report/live_run.hpp"

namespace glocal::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Summarised = std::pair<std::string, Json>;  ///< A variant's name and its summary.

std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free, "set by a signal handler");

/// What --watch stands for without a port.
constexpr const char* any_port = "any";

/// For whoever watches to hear that the run is over.
constexpr std::chrono::seconds longest_farewell{2};

struct RunOptions {
  ExperimentOptions experiment;
  std::vector<std::string> only;
  std::string out;
  int jobs = 1;
  std::string watch;  ///< Port, or any_port; empty if nobody may watch.
  bool force = false;
  bool quiet = false;
};

/// Keeps the variants that are named, in the order of the file.
void select(std::vector<Variant>& variants, const RunOptions& options) {
  std::vector<std::string> names;
  for (const Variant& variant : variants) {
    if (!variant.name.empty()) names.push_back(variant.name);
  }
  std::vector<Fault> faults;
  for (const std::string& name : options.only) {
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    const std::string help =
        names.empty() ? " (the experiment has no variants)" : suggestion(name, names, "there are");
    faults.push_back({"--only " + name, 0, 0, "no such variant" + help});
  }
  if (!faults.empty()) throw ConfigError(std::move(faults));
  if (options.only.empty()) return;
  std::erase_if(variants, [&](const Variant& variant) {
    return std::find(options.only.begin(), options.only.end(), variant.name) == options.only.end();
  });
}

/// Everything one run after the other needs.
class Runner {
 public:
  Runner(const RunOptions& options, Context& context, fs::path out, LiveRun* live)
      : options_(options),
        context_(context),
        live_(live),
        out_(std::move(out)),
        loader_(context.catalog, [](const std::string& text) { spdlog::warn(text); }) {}

  /// The summaries of the variants that an earlier run has finished; they are taken out of the list. Throws
  /// ConfigError for results of other runs that are in the way.
  std::vector<Summarised> take_finished(std::vector<Variant>& variants);

  /// Runs all, until interrupted; tells the summary of each.
  std::vector<Summarised> run(std::vector<Variant>& variants);

  [[nodiscard]] fs::path folder_of(const Variant& variant) const { return out_ / variant.name; }

 private:
  Json run_one(Variant& variant, Progress& progress);
  [[nodiscard]] std::optional<std::string> why_other(const fs::path& folder, Experiment& experiment);
  void note_trials(const std::vector<Variant>& variants) const;

  const RunOptions& options_;
  Context& context_;
  LiveRun* live_;  ///< Null if nobody may watch.
  fs::path out_;
  ExperimentLoader loader_;
  FileHashes hashes_;
};

std::optional<std::string> Runner::why_other(const fs::path& folder, Experiment& experiment) {
  return why_other_run(folder, effective_yaml(experiment, context_.catalog),
                       fs::absolute(options_.experiment.file), hashes_);
}

std::vector<Summarised> Runner::take_finished(std::vector<Variant>& variants) {
  std::vector<Summarised> finished;
  std::vector<Fault> faults;
  if (fs::exists(out_ / "provenance.json")) {
    faults.push_back({out_.string(), 0, 0,
                      "output: the folder has results of a run without variants; choose another one with "
                      "--out"});
  }
  std::erase_if(variants, [&](Variant& variant) {
    const fs::path folder = folder_of(variant);
    if (!fs::exists(folder / "provenance.json")) return false;
    const auto why = why_other(folder, variant.experiment);
    if (why && !options_.force) {
      faults.push_back(
          {folder.string(), 0, 0,
           fmt::format("output: the folder has results of another run: {}; choose another folder "
                       "with --out, or replace earlier results with --force",
                       *why)});
    }
    if (why || fs::exists(folder / journal_folder)) return false;
    if (!options_.quiet) spdlog::info("{}: kept, as an earlier run has finished it", variant.name);
    std::ifstream summary(folder / "summary.json");
    finished.emplace_back(variant.name, Json::parse(summary));
    return true;
  });
  if (!faults.empty()) throw ConfigError(std::move(faults));
  return finished;
}

void Runner::note_trials(const std::vector<Variant>& variants) const {
  if (options_.quiet) return;
  for (const Variant& variant : variants) {
    if (variant.changes_trials)
      spdlog::info("{}: has a seed, a map, observations or trials of its own: other starts or other noise",
                   variant.name);
  }
}

std::vector<Summarised> Runner::run(std::vector<Variant>& variants) {
  note_trials(variants);
  std::size_t trials = 0;
  for (const std::size_t n : count_trials(variants, loader_, context_.catalog)) trials += n;
  Progress progress(!options_.quiet, trials);
  std::vector<Summarised> summaries;
  for (Variant& variant : variants) {
    if (interrupted && !summaries.empty()) break;
    progress.begin(variant.name);
    summaries.emplace_back(variant.name, run_one(variant, progress));
  }
  return summaries;
}

Json Runner::run_one(Variant& variant, Progress& progress) {
  Experiment& experiment = variant.experiment;
  const Catalog& catalog = context_.catalog;
  LoadedExperiment& loaded = loader_.load(experiment);
  loaded.inputs.insert(fs::absolute(options_.experiment.file));
  loaded.inputs.insert(context_.plugins.loaded().begin(), context_.plugins.loaded().end());
  const auto start = std::chrono::steady_clock::now();
  std::vector<Localizer> localizers;
  localizers.push_back(make_localizer(experiment, catalog, loaded));
  const double map_index_ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();

  // Nothing is written before everything is known to be in order.
  std::optional<std::string> declined;
  OutputFolder folder(folder_of(variant), options_.force, [&](const fs::path& earlier) {
    if (!fs::exists(earlier / journal_folder)) return false;
    declined = why_other(earlier, experiment);
    return !declined;
  });
  if (declined)
    spdlog::warn("{}: starts afresh: what an earlier run has left unfinished is dropped, as {}",
                 folder.path().string(), *declined);
  RunResults results(folder, experiment.output, loaded.starts.size());
  const std::size_t trials = loaded.starts.size();
  const std::size_t before = trials - results.to_run().size();
  if (before > 0 && !options_.quiet)
    spdlog::info("{}: goes on where an earlier run has stopped: {} of {} trials are finished",
                 folder.path().string(), before, trials);
  progress.skip(before);
  folder.write("effective.yaml", effective_yaml(experiment, catalog, *loaded.map));
  Json origin = provenance(catalog, experiment.threads, loaded.inputs, hashes_);
  origin["jobs"] = options_.jobs;
  folder.write("provenance.json", origin.dump(2) + "\n");
  if (experiment.output.maps != "none") folder.write("maps/global.pcd", pcd(loaded.map->points()));

  while (localizers.size() < std::min(static_cast<std::size_t>(options_.jobs), results.to_run().size()))
    localizers.push_back(make_localizer(experiment, catalog, loaded));
  const double steps =
      static_cast<double>(std::min(loaded.drive.samples.size(), step_limit(experiment.trials)));
  const auto on_step = [&](std::size_t trial, const StepRecord& record, const Localizer& now) {
    const Sample& sample = loaded.drive.samples[loaded.starts[trial] + record.result.step];
    results.step(trial, record, sample.observation.scan, now);
    progress.step(trial, record.result.step, static_cast<double>(record.result.step) / steps,
                  to_string(record.result.verdict.kind));
    if (live_ != nullptr) live_->step(trial, record, now.local_map().points, progress.now());
  };
  const auto on_done = [&](const TrialRecord& record) {
    results.finish(record);
    progress.finish(record.trial);
    if (live_ != nullptr) live_->finish(record, progress.now());
    if (record.outcome == Outcome::failed)
      spdlog::error("trial {} failed in step {}: {}", record.trial, record.records.size(), record.why);
  };
  if (live_ != nullptr)
    live_->begin(variant.name, folder.path(), read_settings(folder.unfinished(), origin["inputs_sha256"]),
                 loaded);
  const bool complete = run_trials(localizers, experiment, loaded, results.to_run(),
                                   {on_step, on_done, [] { return interrupted.load(); }});

  Json summary =
      results.put_together().to_json({experiment.name, experiment.seed, complete, loaded.map->points().size(),
                                      loaded.map_build_ms, map_index_ms, localizers.front().map_index()});
  folder.write("summary.json", summary.dump(2) + "\n");
  folder.commit();
  // Only now: a run that is killed before goes on with it.
  if (complete) fs::remove_all(folder.path() / journal_folder);
  if (!complete)
    spdlog::warn("interrupted: {} of {} trials were finished and kept",
                 summary["trials"]["count"].get<std::size_t>(), trials);
  return summary;
}

void run(const RunOptions& options, Context& context) {
  std::vector<Variant> variants = options.experiment.read_variants(options.experiment.file, context);
  select(variants, options);
  const fs::path out =
      options.out.empty() ? fs::path("results") / variants.front().experiment.name : fs::path(options.out);
  std::vector<std::string> names;
  for (const Variant& variant : variants) names.push_back(variant.name);
  const bool has_variants = !names.front().empty();
  // From here on an interrupt ends the run in good order.
  std::signal(SIGINT, [](int) { interrupted = true; });
  std::signal(SIGTERM, [](int) { interrupted = true; });
  LiveRun live(variants.front().experiment.name);
  std::optional<WatchServer> server;
  if (!options.watch.empty()) {
    server.emplace(options.watch == any_port ? 0 : std::stoi(options.watch), live);
    spdlog::info("watch: http://127.0.0.1:{}/", server->port());
  }
  Runner runner(options, context, out, server ? &live : nullptr);
  std::vector<Summarised> summaries;
  if (has_variants) summaries = runner.take_finished(variants);
  for (auto& summary : runner.run(variants)) summaries.push_back(std::move(summary));
  live.end();
  if (!interrupted) live.wait_until_told(longest_farewell);
  const auto place = [&](const Summarised& s) { return std::find(names.begin(), names.end(), s.first); };
  std::sort(summaries.begin(), summaries.end(),
            [&](const Summarised& a, const Summarised& b) { return place(a) < place(b); });

  for (const auto& [name, summary] : summaries) {
    if (summary["trials"].contains("failed")) context.exit_code = 1;
  }
  const bool complete = summaries.size() == names.size() &&
                        std::all_of(summaries.begin(), summaries.end(), [](const auto& named) {
                          return named.second["complete"].template get<bool>();
                        });
  if (!complete) context.exit_code = 3;
  if (options.quiet) return;
  if (has_variants) {
    print_table(summaries, fs::absolute(out));
  } else {
    print_summary(summaries.front().second, fs::absolute(out).lexically_normal());
  }
}

}  // namespace

void add_run(CLI::App& app, Context& context) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command =
      app.add_subcommand("run", "Run an experiment, or all its variants, and leave the results in a folder.");
  options->experiment.add_to(*command);
  command->add_option("--only", options->only, "Run only this variant (repeatable)")->allow_extra_args(false);
  command->add_option("--out", options->out, "Folder for the results (default: results/NAME)");
  command->add_option("--jobs", options->jobs, "Trials that run side by side, each with --threads of its own")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  command
      ->add_flag(fmt::format("--watch{{{}}}", any_port), options->watch,
                 "Show the run while it goes on, in a browser on this machine; --watch=PORT to choose where")
      ->check((CLI::IsMember({any_port, "0"}) | CLI::Range(1024, 65535)).description(""));
  command->add_flag("--force", options->force, "Replace earlier results in that folder");
  command->add_flag("--quiet", options->quiet, "No progress and no summary");
  command->callback([options, &context] { run(*options, context); });
}

}  // namespace glocal::app
