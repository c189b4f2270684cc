// What a report shows of runs, as JSON for its page.
#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/comparison/comparison.hpp"
#include "evaluation/results/fault_collector.hpp"
#include "evaluation/results/results_folder.hpp"
#include "report/page.hpp"
#include "report/point_lives.hpp"
#include "report/scan_frames.hpp"
#include "report/step_columns.hpp"

namespace glocal {

/// What keeps a report small enough for a browser.
struct ReportLimits {
  /// Of each step, of those that the run has listed.
  std::size_t clusters = std::numeric_limits<std::size_t>::max();
  std::size_t lives = 250'000;          ///< Of points of local maps, in the whole report.
  std::size_t scan_points = 1'000'000;  ///< In the whole report.
};

/// {"text", "identity"} by path; the identity only where it is not the text.
[[nodiscard]] nlohmann::ordered_json to_json(const std::map<std::string, Setting>& settings);

/// What every report begins with.
[[nodiscard]] nlohmann::ordered_json report_head();

class ReportData {
 public:
  explicit ReportData(const ReportLimits& limits) : limits_(limits) {}

  /// Reads all that a run has left. Throws ConfigError with every fault of the folder.
  StoredRun add(const std::filesystem::path& folder);

  /// `runs` are those that were added, in this order, with their names. A trial that has left steps, local
  /// maps or scans names the chunk that holds them as {"columns", "local_map", "scans"}.
  [[nodiscard]] PageData page_data(const std::vector<NamedRun>& runs, std::size_t baseline) const;

 private:
  struct Trial {
    nlohmann::ordered_json line;  ///< Of trials.jsonl.
    std::optional<StepColumns> steps = {};
    std::optional<PointLives> local_map = {};
    std::optional<ScanFrames> scans = {};
    nlohmann::ordered_json changes = {};  ///< As changes_json() makes them; null without any.
  };
  struct Run {
    std::filesystem::path folder;
    nlohmann::ordered_json summary, provenance;
    std::map<std::string, Setting> settings;
    std::optional<std::size_t> map;
    std::map<std::size_t, Trial> trials;
  };

  [[nodiscard]] StoredRun read_files(Run& run, FaultCollector& faults) const;
  void read_map(Run& run, FaultCollector& faults);
  void read_recordings(Run& run, std::size_t number, FaultCollector& faults);
  void share_limits();
  [[nodiscard]] static nlohmann::ordered_json chunk_of(const Trial& trial);
  static void add_run(PageData& page, const Run& run, const NamedRun& named);

  ReportLimits limits_;
  std::vector<Run> runs_;
  nlohmann::ordered_json maps_ = nlohmann::ordered_json::array();
  std::size_t trials_with_maps_ = 0, trials_with_scans_ = 0;
};

}  // namespace glocal
