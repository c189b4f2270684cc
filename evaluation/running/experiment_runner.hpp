// Runs an experiment, or each of its variants, and leaves results in folders.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/results/output_folder.hpp"
#include "evaluation/results/results_folder.hpp"
#include "evaluation/running/variant_run.hpp"
#include "glocal/run_experiment.hpp"

namespace glocal {

/// A variant that is about to run, with all that is known of it. Good until the next one.
struct LoadedVariant {
  const std::string& name;
  const std::filesystem::path& folder;
  const Experiment& experiment;
  const LoadedExperiment& loaded;
  const std::map<std::string, Setting>& settings;
  std::size_t finished;  ///< Trials that an earlier run has finished.
};

/// What to do while an experiment runs: as RunObserver, with what only this library's own callers may see.
struct RunnerCallbacks {
  /// So many trials there are, of all variants. Comes before anything is written.
  std::function<void(std::size_t trials)> counted = [](std::size_t) {};
  std::function<void(const LoadedVariant&)> begin = [](const LoadedVariant&) {};
  RunCallbacks trials;
  std::function<void(const std::string&)> note, warn;
  TellProgress progress = [](double) {};  ///< Of reading what takes long.
};

/// What a variant has come to, by its summary.json.
[[nodiscard]] VariantResult result_of_variant(const std::string& name, const std::filesystem::path& folder,
                                              const nlohmann::ordered_json& summary);

class ExperimentRunner {
 public:
  /// `file` is where the variants were read from; there is at least one.
  ExperimentRunner(std::vector<Variant> variants, const std::filesystem::path& file, const Catalog& catalog,
                   RunOptions options, RunnerCallbacks callbacks);

  /// Runs all, until stopped. Throws as run_experiment() does.
  RunResult run();

 private:
  void select();
  void take_finished();
  void warn_of_others(const std::vector<std::string>& names) const;
  void check_outputs();
  void note_trials() const;
  void run_one(Variant& variant);
  void begin(const Variant& variant, const OutputFolder& folder, const VariantRun& run, std::size_t finished);
  void put_in_place(OutputFolder& folder, const std::string& variant, const nlohmann::ordered_json& summary);
  [[nodiscard]] std::optional<std::string> why_other(const std::filesystem::path& folder, Variant& variant);
  void add_result(const std::string& name, const nlohmann::ordered_json& summary) {
    results_.push_back(result_of_variant(name, folder_of(name), summary));
  }
  [[nodiscard]] std::filesystem::path folder_of(const std::string& variant) const { return out_ / variant; }

  std::vector<Variant> variants_;
  std::filesystem::path file_;
  const Catalog& catalog_;
  RunOptions options_;
  RunnerCallbacks callbacks_;
  std::filesystem::path out_;
  ExperimentLoader loader_;
  std::vector<VariantResult> results_;
};

}  // namespace glocal
