// A whole experiment, as a YAML file describes it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "glocal/catalog.hpp"
#include "glocal/localizer.hpp"
#include "glocal/params.hpp"

namespace glocal {

/// Where localization starts, and for how long it may go on. Exactly one of the first four is given.
struct TrialsConfig {
  double every_m = 0.0;
  std::vector<double> starts_m;
  int every_scan = 0;
  bool whole = false;
  int max_steps = 60;
  int min_steps = 1;
  double within_map_m = 0.0;
  std::vector<double> only = {};  ///< Whole numbers; empty: all.
};
void describe(ParamVisitor& v, TrialsConfig& p);

/// What counts as a right answer.
struct EvaluationConfig {
  double max_translation_error = 0.5;
  double max_rotation_error_deg = 10.0;
};
void describe(ParamVisitor& v, EvaluationConfig& p);

/// What a run writes besides the summary.
struct OutputConfig {
  bool steps = true;
  bool trajectories = true;
  int clusters = 50;
  std::string maps = "first_trial";
};
void describe(ParamVisitor& v, OutputConfig& p);

/// An experiment without its variants.
struct Experiment {
  int schema = 1;
  std::string name;
  std::uint64_t seed = 1;
  int threads = 1;
  std::vector<FilePath> plugins;
  StrategyChoice map;
  StrategyChoice observations;
  TrialsConfig trials;
  LocalizerConfig localizer;
  EvaluationConfig evaluation;
  OutputConfig output;
};
/// What draws random numbers in an experiment. Each has a stream of its own, so that none repeats what
/// another one has drawn.
enum class RandomPart : std::uint64_t { map_source = 1, observation_source, localizer };

/// The seed of one of them.
[[nodiscard]] std::uint64_t seed_of(RandomPart part, const Experiment& experiment);

/// Unlike other descriptions this one needs to know which strategies there are.
void describe(ParamVisitor& v, Experiment& e, const Catalog& catalog);

/// An experiment with every stage at its default (the paper's method); map, observations and trials are left
/// open.
[[nodiscard]] Experiment default_experiment();

/// `path=value` as given with --set, for example {"localizer.matcher.ransam.iterations", "50000"}; the value
/// is YAML.
using Override = std::pair<std::string, std::string>;

/// Reads an experiment file, without its variants; one of several methods or cases needs overrides that leave
/// one of each (methods=[indexed]). Throws ConfigError with every fault found in it and in the overrides.
[[nodiscard]] Experiment read_experiment(const std::filesystem::path& file,
                                         const std::vector<Override>& overrides, const Catalog& catalog);

/// A localizer's values, of which `overrides` change some, as in {"matcher.ransam.iterations", "50000"}.
/// Throws ConfigError with every fault found in them.
[[nodiscard]] LocalizerConfig read_localizer(const std::vector<Override>& overrides, const Catalog& catalog);

struct Suite;

/// What the results of a case are for.
enum class CaseRole {
  none,    ///< There are no cases.
  choose,  ///< By these the best setting is chosen …
  judge,   ///< … and by these it is judged.
};
[[nodiscard]] const char* to_string(CaseRole role);

/// One experiment of a file with variants: a setting, run on a case with a seed.
struct Variant {
  /// Fit for a folder: `SETTING_CASE_seed-N`, without what there is none of. Empty for the experiment of a
  /// file that has nothing of this.
  std::string name;
  Experiment experiment;
  /// Its setting has another map, other observations, trials or another seed.
  bool changes_trials = false;
  std::string setting =
      {};  ///< What is compared: one of several methods, and changes; empty if only case and seed vary.
  std::string case_name = {};  ///< One of `cases`, choose_on or judge_on; empty without.
  CaseRole role = CaseRole::none;
  /// What the setting changes, as written; not the case, nor the seed. The method counts as a value of the
  /// path `method`.
  std::vector<Override> values = {};
  std::shared_ptr<const Suite> suite = nullptr;  ///< That case and seed are of; null if of none.
  double share = 1.0;                            ///< Of the suite's starts, which are in trials.only.
};

/// Reads the variants of an experiment file: of each method with each case (those of choose_on first) the
/// settings in the order of list, grid and zip, each with every seed; of a file without any, the experiment
/// itself. Overrides are applied before the variants' changes. Without a file they say all. Throws
/// ConfigError with every fault of all variants.
[[nodiscard]] std::vector<Variant> read_variants(const std::filesystem::path& file,
                                                 const std::vector<Override>& overrides,
                                                 const Catalog& catalog);

/// The plugins that an experiment file names, as far as they are there: to be loaded before the file is read.
/// Says nothing of faults, which read_experiment() finds.
[[nodiscard]] std::vector<FilePath> read_plugins(const std::filesystem::path& file,
                                                 const std::vector<Override>& overrides);

/// The experiment as YAML with every value, defaulted or not; reading it again gives the same experiment.
[[nodiscard]] std::string effective_yaml(Experiment& experiment, const Catalog& catalog);
/// The same with comments on what follows from the map.
[[nodiscard]] std::string effective_yaml(Experiment& experiment, const Catalog& catalog,
                                         const GlobalMap& map);

}  // namespace glocal
