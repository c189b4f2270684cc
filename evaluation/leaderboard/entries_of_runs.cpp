#include "evaluation/leaderboard/entries_of_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "evaluation/results/fault_collector.hpp"
#include "evaluation/results/provenance.hpp"
#include "evaluation/results/summary.hpp"
#include "evaluation/statistics/hypothesis_tests.hpp"
#include "evaluation/statistics/statistics.hpp"
#include "glocal/error.hpp"

namespace glocal {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Two digits say all that a time on a machine that does other things is worth.
double two_digits(double value) {
  return std::stod(fmt::format("{:.2g}", value));
}

Json provenance_of_entry(const StoredRun& run, const std::string& command) {
  const Json& from = run.provenance;
  const std::string began = from.value("began", std::string());
  return {{"version", from.value("version", "")},
          {"revision", from.value("revision", "")},
          {"date", began.substr(0, began.find('T'))},
          {"command", command},
          {"cpu", run.machine.cpu},
          {"method_sha256", hash_of_method(run.settings)}};
}

/// A folder of results as part of an entry.
class RunReader {
 public:
  explicit RunReader(const fs::path& folder)
      : run_(read_results(
            folder, {.trial = [](const Json&) {}, .step = [this](const Json& step) { add_step(step); }})) {
    if (!run_.complete) throw ConfigError(folder, "is not complete; run it again, and it goes on");
    const Json variant = run_.provenance.value("variant", Json::object());
    if (!variant.is_object() || !variant.contains("suite"))
      throw ConfigError(folder, "was not run with --suite; run a suite");
    suite_ = variant.at("suite");
    method_ = variant.at("setting");
    share_ = variant.value("share", 1.0);
    result_ = {.case_name = variant.at("case"), .seed = run_.seed, .numbers = {}, .starts = {}};
    result_.numbers = numbers_in_share(result_.case_name, result_.seed, share_, run_.trials.size());
    for (const auto& [start, trial] : run_.trials) {
      std::optional<PoseError> error;
      if (trial.translation_error_m)
        error = {*trial.translation_error_m, radians(trial.rotation_error_deg.value_or(0.0))};
      result_.starts.push_back(
          start_result(trial.outcome, static_cast<std::size_t>(trial.steps), trial.distance_m, error));
    }
    if (const auto ms = median_if_any(std::move(step_ms_))) result_.step_ms = two_digits(*ms);
    if (run_.settings.at("trials.whole").text == "true") add_drive();
  }

  /// Adds it to the entry of its method.
  void add_to(std::vector<BoardEntry>& entries) {
    const auto same = [&](const BoardEntry& e) { return e.suite == suite_ && e.method == method_; };
    auto entry = std::find_if(entries.begin(), entries.end(), same);
    if (entry == entries.end()) {
      entries.push_back({.suite = suite_, .method = method_, .share = share_, .results = {}});
      entry = std::prev(entries.end());
      entry->provenance = provenance_of_entry(run_, entry->command(suite_));
    } else if (entry->share != share_) {
      throw ConfigError(
          run_.folder,
          fmt::format("has a share of {} of the starts, and the results beside it {}", share_, entry->share));
    } else if (entry->provenance.at("revision") != run_.provenance.value("revision", "")) {
      throw ConfigError(run_.folder,
                        fmt::format("is by another version of the program than the results beside it "
                                    "({} and {}); run all with one",
                                    run_.provenance.value("revision", ""),
                                    entry->provenance.at("revision").get<std::string>()));
    } else if (entry->provenance.at("method_sha256") != hash_of_method(run_.settings)) {
      throw ConfigError(
          run_.folder, "has other values of the localizer than the results beside it; run all with the same");
    }
    // All processors that times are of are named.
    auto& cpu = entry->provenance.at("cpu").get_ref<std::string&>();
    if (cpu.find(run_.machine.cpu) == std::string::npos) cpu += ", " + run_.machine.cpu;
    entry->results.push_back(std::move(result_));
  }

 private:
  void add_step(const Json& step) {
    if (step.contains("stage_cpu_ms")) step_ms_.push_back(stage_times(step, "stage_cpu_ms").total());
    const std::size_t clusters = step.at("clusters");
    if (!first_clusters_) first_clusters_ = clusters;
    last_clusters_ = clusters;
  }

  void add_drive() {
    require_steps(run_);
    const Json& later = run_.summary.at("after_declaration");
    result_.drive =
        whole_drive(later.at("steps"), later.at("translation_error_m").at("max"),
                    later.at("rotation_error_deg").at("max"), first_clusters_.value_or(0), last_clusters_);
  }

  std::vector<double> step_ms_;
  std::optional<std::size_t> first_clusters_;
  std::size_t last_clusters_ = 0;
  StoredRun run_;
  std::string suite_, method_;
  double share_ = 1.0;
  CaseResult result_;
};

WholeDrive drive_of(const TrialRecord& record) {
  double translation = 0.0;
  double rotation = 0.0;
  const std::vector<PoseError> errors = figures_of(record).later_errors;
  for (const PoseError& error : errors) {
    translation = std::max(translation, error.translation_m);
    rotation = std::max(rotation, degrees(error.rotation_rad));
  }
  const auto clusters = [](const StepRecord& step) { return step.result.clusters.size(); };
  const bool any = !record.records.empty();
  return whole_drive(errors.size(), translation, rotation, any ? clusters(record.records.front()) : 0,
                     any ? clusters(record.records.back()) : 0);
}

std::string text_of_start(const StartResult& start) {
  std::string text = fmt::format("{} after {} steps", to_string(start.outcome), start.steps);
  if (start.cm) text += fmt::format(", {} cm, {} deg", *start.cm, start.deg.value_or(0.0));
  return text;
}

std::string text_of_drive(const WholeDrive& drive) {
  return fmt::format("localized in {} steps, at most {} cm, {} deg off, {} clusters at first and {} at last",
                     drive.localized, drive.cm, drive.deg, drive.first_clusters, drive.last_clusters);
}

/// How often something holds before and now, start by start, and whether a change can be chance.
class Change {
 public:
  void add(bool was, bool is) {
    before_ += was ? 1 : 0;
    now_ += is ? 1 : 0;
    differences_.push_back((is ? 1 : 0) - (was ? 1 : 0));
  }

  [[nodiscard]] std::string text(const char* what) const {
    const auto count = [&](long difference) { return std::ranges::count(differences_, difference); };
    return fmt::format("  {:<6} {} before, {} now: {} no more, {} newly (p {:.2g})\n", what, before_, now_,
                       count(-1), count(1), sign_flip_test(differences_).p);
  }

 private:
  std::size_t before_ = 0, now_ = 0;
  std::vector<long> differences_;
};

}  // namespace

std::string hash_of_method(const std::map<std::string, Setting>& settings) {
  std::string text;
  for (const auto& [path, setting] : settings) {
    if (path.starts_with("localizer.")) text += path + "=" + setting.identity + "\n";
  }
  return sha256_of_text(text);
}

std::vector<BoardEntry> entries_of_folder(const fs::path& folder) {
  std::vector<BoardEntry> entries;
  FaultCollector faults;
  for (const fs::path& run : results_folders(folder)) faults.collect([&] { RunReader(run).add_to(entries); });
  faults.report();
  return entries;
}

CaseResult run_in_memory(const Variant& variant, LoadedExperiment& loaded, const Catalog& catalog) {
  CaseResult result{
      .case_name = variant.case_name, .seed = variant.experiment.seed, .numbers = {}, .starts = {}};
  for (std::size_t i = 0; i < loaded.starts.size(); ++i)
    result.numbers.push_back(start_number(variant.experiment.trials, i));
  result.starts.resize(loaded.starts.size());
  std::vector<Localizer> localizers;
  localizers.push_back(make_localizer(variant.experiment, catalog, loaded));
  std::vector<std::size_t> trials(loaded.starts.size());
  for (std::size_t i = 0; i < trials.size(); ++i) trials[i] = i;
  const auto keep = [&](const TrialRecord& record) {
    result.starts[record.trial] = start_result(record.outcome, record.steps, record.distance_m, record.error);
    if (variant.experiment.trials.whole) result.drive = drive_of(record);
  };
  run_trials(localizers, variant.experiment, loaded, trials,
             {[](std::size_t, const StepRecord&, const Localizer&) {}, keep, [] { return false; }});
  return result;
}

std::vector<std::string> differences(const CaseResult& stored, const CaseResult& fresh) {
  std::vector<std::string> lines;
  const std::string of = fmt::format("{}, seed {}", stored.case_name, stored.seed);
  for (std::size_t i = 0; i < fresh.starts.size(); ++i) {
    const StartResult* was = stored.find(fresh.numbers[i]);
    if (was == nullptr || *was == fresh.starts[i]) continue;
    lines.push_back(fmt::format("{}, start {}: {} is stored, {} it is now", of, fresh.numbers[i],
                                text_of_start(*was), text_of_start(fresh.starts[i])));
  }
  if (lines.empty() && stored.drive && fresh.drive && *stored.drive != *fresh.drive)
    lines.push_back(fmt::format("{}: {} is stored, {} it is now", of, text_of_drive(*stored.drive),
                                text_of_drive(*fresh.drive)));
  return lines;
}

std::string paired_text(const BoardEntry& before, const BoardEntry& now) {
  Change right;
  Change wrong;
  std::vector<double> steps;
  for (const CaseResult& result : now.results) {
    const CaseResult* old = before.find(result.case_name, result.seed);
    if (old == nullptr) continue;
    for (std::size_t i = 0; i < result.starts.size(); ++i) {
      const StartResult* earlier = old->find(result.numbers[i]);
      if (earlier == nullptr) continue;
      const StartResult& a = *earlier;
      const StartResult& b = result.starts[i];
      right.add(a.outcome == Outcome::right, b.outcome == Outcome::right);
      wrong.add(a.outcome == Outcome::wrong, b.outcome == Outcome::wrong);
      if (a.outcome == Outcome::right && b.outcome == Outcome::right)
        steps.push_back(static_cast<double>(b.steps) - static_cast<double>(a.steps));
    }
  }
  const auto fewer = std::count_if(steps.begin(), steps.end(), [](double d) { return d < 0.0; });
  const auto more = std::count_if(steps.begin(), steps.end(), [](double d) { return d > 0.0; });
  return fmt::format("{} of {}, start by start:\n", now.method, now.suite) + wrong.text("wrong") +
         right.text("right") +
         fmt::format(
             "  steps  {} of {} starts that are right both times need fewer, {} more, by {:.2g} in the mean "
             "of all (p {:.2g})\n",
             fewer, steps.size(), more, mean(steps), wilcoxon_signed_rank(steps).p);
}

}  // namespace glocal
