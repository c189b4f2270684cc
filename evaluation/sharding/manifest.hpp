// What there is to do in a folder that shards share, and what it follows from.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "evaluation/results/journal.hpp"
#include "evaluation/results/provenance.hpp"
#include "evaluation/results/results_folder.hpp"
#include "evaluation/running/experiment_loader.hpp"
#include "glocal/catalog.hpp"
#include "glocal/error.hpp"
#include "glocal/experiment.hpp"

namespace glocal {

/// Of each trial where it starts, and the most steps it may take.
struct PlannedStarts {
  std::vector<std::size_t> samples, steps;
  friend bool operator==(const PlannedStarts&, const PlannedStarts&) = default;
};

struct PlannedVariant {
  std::string name;  ///< Empty for an experiment without variants.
  /// Hash of all that its results follow from: values, input files by what is in them, plugins.
  std::string identity;
  std::string text;                           ///< Hash of the effective experiment, as YAML.
  std::map<std::string, std::string> values;  ///< All of the experiment, as text, by path.
  std::size_t starts = 0;                     ///< Which of the manifest's lists.
  nlohmann::ordered_json origin;              ///< As origin_json() tells.
};

struct Manifest {
  std::string experiment;
  std::string file;
  nlohmann::ordered_json program;              ///< As program_identity() tells.
  std::map<std::string, std::string> plugins;  ///< SHA-256 by file.
  std::map<std::string, std::string> inputs;   ///< SHA-256 by file.
  std::vector<PlannedStarts> starts;           ///< Variants with the same ones share a list.
  std::vector<PlannedVariant> variants;

  [[nodiscard]] const PlannedStarts& starts_of(std::size_t variant) const {
    return starts[variants[variant].starts];
  }
  [[nodiscard]] TrialId id_of(std::size_t variant, std::size_t trial) const {
    return trial_id(variants[variant].identity, trial, starts_of(variant).samples[trial]);
  }
  [[nodiscard]] std::size_t count_trials() const;
};

/// Of variants by name.
[[nodiscard]] std::map<std::string, std::size_t> places_of(const Manifest& manifest);

/// The most steps of each trial, by variant and trial.
[[nodiscard]] std::vector<std::vector<std::size_t>> steps_of(const Manifest& manifest);

/// Where a shared folder has what shards need, and the journals in there.
inline constexpr const char* shards_folder = ".shards";
[[nodiscard]] std::filesystem::path manifest_file(const std::filesystem::path& shared);
[[nodiscard]] std::filesystem::path journals_folder(const std::filesystem::path& shared);

/// Whether shards share this folder.
[[nodiscard]] bool is_shared_folder(const std::filesystem::path& folder);

/// The hash that PlannedVariant::identity is. Throws RunError if a file cannot be read.
[[nodiscard]] std::string identity_of(const Experiment& experiment,
                                      const std::set<std::filesystem::path>& inputs,
                                      const std::vector<std::filesystem::path>& plugins,
                                      ExperimentLoader& loader);

/// What can be said of variants before anything is loaded: without identities, values, inputs and starts.
[[nodiscard]] Manifest sketch_of(const std::vector<Variant>& variants, const std::filesystem::path& file,
                                 const std::vector<std::filesystem::path>& plugins, const Catalog& catalog,
                                 FileHashes& hashes);

/// Loads all, so that whatever is wrong with any variant shows, and says what there is to do. Throws
/// ConfigError.
[[nodiscard]] Manifest plan(std::vector<Variant>& variants, const std::filesystem::path& file,
                            const std::vector<std::filesystem::path>& plugins, ExperimentLoader& loader);

/// Faults that say how what is asked for differs from what a folder was made for; none if it is the same, or
/// has more variants. `here` is the sketch of `variants`.
[[nodiscard]] std::vector<Fault> differences(const Manifest& there, const Manifest& here,
                                             const std::vector<Variant>& variants, const Catalog& catalog,
                                             const std::filesystem::path& shared);

/// Whether some variant of `here` is not planned there.
[[nodiscard]] bool has_more_variants(const Manifest& there, const Manifest& here);

/// Writes it in place of one that may be there. Throws RunError.
void write_manifest(const std::filesystem::path& shared, const Manifest& manifest);

/// Throws ConfigError if the folder has none, or a damaged one.
[[nodiscard]] Manifest read_manifest(const std::filesystem::path& shared);

}  // namespace glocal
