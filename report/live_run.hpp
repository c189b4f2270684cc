// A run while it goes on, for whoever watches it.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "evaluation/results/results_folder.hpp"
#include "evaluation/running/experiment_loader.hpp"
#include "glocal/points.hpp"
#include "report/step_columns.hpp"

namespace glocal {

/// How far a run is, of all its variants.
struct RunProgress {
  std::size_t finished = 0, trials = 0;
  std::optional<double> remaining_s = {};  ///< None as long as it cannot be told.
};

/// The data of a report, of a run that is not over. Calls may come from any thread; a step costs those who
/// run it no more than its numbers and a copy of its points: the rest is the work of who asks.
class LiveRun {
 public:
  explicit LiveRun(std::string experiment) : experiment_(std::move(experiment)) {}

  /// Another variant runs from now on, into this folder. `loaded` must stay until the variant's last step.
  void begin(const std::string& variant, const std::filesystem::path& folder,
             const std::map<std::string, Setting>& settings, const LoadedExperiment& loaded);
  /// To be called after each step of a trial.
  void step(std::size_t trial, const StepRecord& record, const Points& local_map,
            const RunProgress& progress);
  void finish(const TrialRecord& trial, const RunProgress& progress);
  /// No variant is left.
  void end();

  struct News {
    std::uint64_t version = 0;
    nlohmann::ordered_json data;
  };
  /// None if version `known` is what there is.
  [[nodiscard]] std::optional<News> news(std::optional<std::uint64_t> known = std::nullopt);

  /// Notes that a watcher has been told this version.
  void told(std::uint64_t version);
  /// Waits until a watcher has been told all, if there is one, but no longer than this.
  void wait_until_told(std::chrono::milliseconds longest);

 private:
  /// Of each step; few, as everything is told again and again.
  static constexpr int clusters = 10;

  struct RunningTrial {
    nlohmann::ordered_json start = {};
    StepColumns columns{clusters};
    std::size_t step = 0;  ///< The latest.
    Points local_map = {}, hits = {};
  };
  /// With its columns, as long as there are not too many.
  struct FinishedTrial {
    std::size_t steps = 0;
    std::shared_ptr<const nlohmann::ordered_json> line = {}, columns = {};
  };

  void forget_old_steps();

  std::mutex mutex_;
  std::string experiment_, variant_, folder_;
  nlohmann::ordered_json settings_ = nlohmann::ordered_json::object();
  std::shared_ptr<const nlohmann::ordered_json> map_;
  const LoadedExperiment* loaded_ = nullptr;
  std::map<std::size_t, RunningTrial> running_;
  std::map<std::size_t, FinishedTrial> finished_;
  RunProgress progress_;
  bool is_over_ = false;
  std::uint64_t version_ = 1;

  using Clock = std::chrono::steady_clock;
  std::condition_variable was_told_;
  std::uint64_t told_version_ = 0;
  std::optional<Clock::time_point> told_at_;
};

}  // namespace glocal
