#include "app/results_at_hand.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdlib>
#include <system_error>

#include "app/standard_streams.hpp"
#include "evaluation/comparison/named_runs.hpp"
#include "evaluation/results/results_folder.hpp"
#include "evaluation/sharding/merge.hpp"
#include "glocal/error.hpp"

namespace glocal::app {
namespace {

namespace fs = std::filesystem;

bool is_merged(const Manifest& manifest, const fs::path& shared) {
  return std::all_of(manifest.variants.begin(), manifest.variants.end(),
                     [&](const PlannedVariant& v) { return is_complete(shared / v.name) == true; });
}

}  // namespace

// The object is made by then, so that it is destroyed where something is thrown.
ResultsAtHand::ResultsAtHand(const std::vector<std::string>& folders) : ResultsAtHand() {
  for (const std::string& folder : folders) {
    const bool is_open = is_shared_folder(folder) && !is_merged(read_manifest(folder), folder);
    folders_.push_back(is_open ? put_together(folder).string() : folder);
    if (is_open) given_as_.emplace(folders_.back(), folder);
  }
}

ResultsAtHand::~ResultsAtHand() {
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove_all(temporary_, ignored);
}

std::vector<NamedRun> ResultsAtHand::read(const std::function<StoredRun(const fs::path&)>& read_one) const {
  return read_runs(folders_, [&](const fs::path& folder) {
    StoredRun run = read_one(folder);
    const bool is_variant = !given_as_.contains(folder);
    const auto given = given_as_.find(is_variant ? folder.parent_path() : folder);
    if (given != given_as_.end()) run.folder = is_variant ? given->second / folder.filename() : given->second;
    return run;
  });
}

fs::path ResultsAtHand::put_together(const fs::path& shared) {
  if (temporary_.empty()) {
    std::string pattern = (fs::temp_directory_path() / "glocal_XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) throw RunError("cannot make a temporary folder: " + pattern);
    temporary_ = pattern;
  }
  const Manifest manifest = read_manifest(shared);
  const JournalScan scan(journals_folder(shared), warn);
  // Pages and tables call runs by the names of their folders.
  fs::path out = temporary_ / std::to_string(folders_.size()) / own_name(shared);
  const MergeResult result = merge_shards(manifest, scan, {out});
  if (result.run.variants.empty())
    throw ConfigError(shared, "no trial has come to an end yet; wait for the first");
  spdlog::info("{}: as far as it is: {} of {} trials", shared.string(),
               manifest.count_trials() - result.count_missing(), manifest.count_trials());
  return out;
}

std::vector<NamedRun> read_sweep(const std::string& folder) {
  return ResultsAtHand({folder}).read(
      [](const fs::path& run) { return read_results(run, {}, ResultParts::all_but_steps); });
}

}  // namespace glocal::app
