#include "evaluation/sharding/merge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "evaluation/results/fault_collector.hpp"
#include "evaluation/results/file_io.hpp"
#include "evaluation/results/file_lock.hpp"
#include "evaluation/results/json_text.hpp"
#include "evaluation/results/output_folder.hpp"
#include "evaluation/results/results_folder.hpp"
#include "evaluation/results/run_results.hpp"
#include "evaluation/results/variant_order.hpp"
#include "evaluation/running/experiment_runner.hpp"
#include "glocal/error.hpp"

namespace glocal {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// One variant, or the experiment without variants.
class VariantMerge {
 public:
  VariantMerge(const Manifest& manifest, std::size_t place, const JournalScan& scan,
               const MergeOptions& options)
      : planned_(manifest.variants[place]),
        trials_(scan, planned_.identity, manifest.starts_of(place).samples),
        scan_(scan),
        options_(options),
        folder_(options.out / planned_.name) {
    const auto found = scan.variants().find(planned_.identity);
    if (found == scan.variants().end()) return;
    places_ = &found->second;
    first_ = parse_json(scan.text_at(places_->front()));
  }

  [[nodiscard]] const JournaledTrials& trials() const { return trials_; }
  /// No shard has begun with it.
  [[nodiscard]] bool is_empty() const { return places_ == nullptr; }
  /// The summary of results that are there already, and complete. Throws ConfigError for those of other runs.
  [[nodiscard]] std::optional<Json> kept() const;
  Json write(bool is_complete) const;
  [[nodiscard]] const fs::path& folder() const { return folder_; }
  [[nodiscard]] const std::string& name() const { return planned_.name; }

 private:
  [[nodiscard]] Json description() const;
  void move_up(const fs::path& merged) const;

  const PlannedVariant& planned_;
  JournaledTrials trials_;
  const JournalScan& scan_;
  const MergeOptions& options_;
  fs::path folder_;
  const std::vector<JournalScan::Place>* places_ = nullptr;  ///< Of descriptions; null if there are none.
  Json first_;                                               ///< The first of these.
};

std::optional<Json> VariantMerge::kept() const {
  if (!is_results_folder(folder_)) return std::nullopt;
  const Json there = Json::parse(content_of(folder_ / "provenance.json"), nullptr, false);
  const std::string effective = content_of(folder_ / "effective.yaml");
  // Shards may have other numbers of threads, and the file more seeds by now: it is that of any of them.
  const bool is_same_run = std::ranges::any_of(*places_, [&](const JournalScan::Place& at) {
    const Json described = parse_json(scan_.text_at(at));
    const auto same = [&](const char* key) {
      return there.is_object() && there.contains(key) && there.at(key) == described.at("provenance").at(key);
    };
    return effective == described.at("effective") && same("program_sha256") && same("inputs_sha256");
  });
  if (!is_same_run && !options_.force)
    throw ConfigError(folder_,
                      "output: the folder has results of another run; remove them, or replace them with "
                      "--force");
  if (!is_same_run || is_complete(folder_) != true) return std::nullopt;
  return read_results(folder_).summary;
}

/// What journals say besides trials. Memory is that of the largest process.
Json VariantMerge::description() const {
  Json description = first_;
  Json& origin = description.at("provenance");
  trials_.tell_processes(origin);
  std::set<std::string> cpus;
  double peak = 0.0;
  for (const JournalScan::Place& at : *places_) {
    const Json of_one = parse_json(scan_.text_at(at));
    cpus.insert(of_one.at("provenance").at("cpu").get<std::string>());
    peak = std::max(peak, of_one.at("peak_rss_mb").get<double>());
  }
  origin["cpu"] = fmt::format("{}", fmt::join(cpus, ", "));
  // Variants of the same values share what shards leave, though they have different names.
  if (!planned_.origin.is_null()) origin["variant"] = planned_.origin;
  description["peak_rss_mb"] = peak;
  return description;
}

Json VariantMerge::write(bool is_complete) const {
  // An experiment without variants has its results beside what shards share, and cannot take that folder's
  // place.
  const bool is_beside = planned_.name.empty() && is_shared_folder(folder_);
  const fs::path place = is_beside ? folder_ / shards_folder / "merged" : folder_;
  std::optional<FileLock> lock;
  if (is_beside) {
    lock.emplace(folder_ / shards_folder / "merge.lock", folder_);
    // What a merge that was killed has not moved up any more.
    std::error_code error;
    fs::remove_all(place, error);
    check_written(error, place);
  }
  const Json described = description();
  std::set<fs::path> inputs;
  for (const auto& [file, hash] : described.at("provenance").at("inputs_sha256").items()) inputs.insert(file);
  OutputFolder folder(place, true, inputs);
  write_origin(folder, described);
  Json summary = put_together(folder, described, trials_, is_complete);
  folder.commit();
  if (is_beside) move_up(place);
  return summary;
}

/// The summary goes first and comes last: readers take its word that all is there.
void VariantMerge::move_up(const fs::path& merged) const {
  std::error_code error;
  fs::remove(folder_ / "summary.json", error);
  check_written(error, folder_ / "summary.json");
  std::vector<fs::path> names;
  for (const auto& entry : fs::directory_iterator(merged)) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end(), [](const fs::path& a, const fs::path& b) {
    return std::pair(a == "summary.json", a) < std::pair(b == "summary.json", b);
  });
  for (const fs::path& name : names) {
    std::error_code none;
    if (fs::is_directory(folder_ / name, none)) fs::remove_all(folder_ / name, error);
    check_written(error, folder_ / name);
    fs::rename(merged / name, folder_ / name, error);
    check_written(error, folder_ / name);
  }
  fs::remove(merged, error);
  if (!error) error = sync_to_disk(folder_);
  check_written(error, folder_);
}

/// What journals say is what their checksums are of, but may come from another version.
template <class Work>
auto with_journals(const PlannedVariant& planned, const Work& work) {
  try {
    return work();
  } catch (const ConfigError&) {
    throw;
  } catch (const RunError&) {
    throw;
  } catch (const std::exception& error) {
    throw RunError(fmt::format(
        "{}: what shards have left of it is not as this version writes it ({}); run it into another folder",
        planned.name.empty() ? "the experiment" : "variant '" + planned.name + "'", reason(error)));
  }
}

/// In the order of the file.
std::vector<std::string> variant_names(const Manifest& manifest) {
  std::vector<std::string> names;
  for (const PlannedVariant& variant : manifest.variants) names.push_back(variant.name);
  return names;
}

}  // namespace

std::size_t MergeResult::count_missing() const {
  std::size_t n = 0;
  for (const MissingTrials& of_variant : missing) n += of_variant.trials.size();
  return n;
}

MergeResult merge_shards(const Manifest& manifest, const JournalScan& scan, const MergeOptions& options) {
  MergeResult result;
  result.run.folder = options.out;
  const std::size_t n = manifest.variants.size();
  const auto for_each = [&](const auto& work) {
    for (std::size_t i = 0; i < n; ++i)
      with_journals(manifest.variants[i], [&] { work(i, VariantMerge(manifest, i, scan, options)); });
  };
  // What is in the way is said before anything is written.
  FaultCollector faults;
  std::vector<std::optional<Json>> there(n);  // Summaries of what is complete already.
  for_each([&](std::size_t i, const VariantMerge& merge) {
    if (!merge.is_empty()) faults.collect([&] { there[i] = merge.kept(); });
  });
  faults.report();
  for_each([&](std::size_t i, const VariantMerge& merge) {
    MissingTrials missing{merge.name(), merge.trials().missing()};
    const bool is_complete = missing.trials.empty();
    if (merge.is_empty() && missing.trials.size() < merge.trials().count())
      throw std::invalid_argument("no journal describes it");
    if (!is_complete) result.missing.push_back(std::move(missing));
    if (merge.is_empty()) return;
    const std::optional<Json> kept = is_complete ? std::move(there[i]) : std::nullopt;
    if (kept && !merge.name().empty()) options.note(fmt::format("{}: kept, as it is complete", merge.name()));
    result.run.variants.push_back(
        result_of_variant(merge.name(), merge.folder(), kept ? *kept : merge.write(is_complete)));
  });
  if (!manifest.variants.front().name.empty() && !result.run.variants.empty())
    write_variant_order(options.out, variant_names(manifest));
  result.run.complete = result.missing.empty();
  return result;
}

}  // namespace glocal
