// One variant with all that its trials need: how the run of a whole experiment and a shard run them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>
#include <vector>

#include "evaluation/results/journal.hpp"
#include "evaluation/running/experiment_loader.hpp"
#include "glocal/run_experiment.hpp"

namespace glocal {

class VariantRun {
 public:
  /// Loads the variant, and makes its first localizer. `file` is where it was read from. All that is handed
  /// in must stay, and the loader must not be asked for another variant meanwhile. Throws ConfigError.
  VariantRun(Variant& variant, ExperimentLoader& loader, const std::filesystem::path& file,
             const RunOptions& options);

  [[nodiscard]] const LoadedExperiment& loaded() const { return loaded_; }
  [[nodiscard]] const Localizer& localizer() const { return localizers_.front(); }
  /// Every file that was read, with that of the experiment and those of plugins.
  [[nodiscard]] std::set<std::filesystem::path> inputs() const;
  /// What the results say besides trials: `effective` and `provenance` are whole files, `steps` says whether
  /// steps are written, and `name`, `seed`, `map` and `peak_rss_mb` (so far) are as summary.json has them.
  [[nodiscard]] nlohmann::ordered_json description() const;

  /// Runs these trials, as many at once as the options say, and leaves in the journal what they come to;
  /// false if stopped before the last. `identity` is as identity_of() tells. `with_map`: the first
  /// trial of the variant leaves the files of the map, too, if maps are asked for.
  bool run(const std::string& identity, const std::vector<std::size_t>& trials, Journal& journal,
           const RunCallbacks& callbacks, bool with_map);

 private:
  Variant& variant_;
  ExperimentLoader& loader_;
  std::filesystem::path file_;
  const RunOptions& options_;
  LoadedExperiment& loaded_;
  std::vector<Localizer> localizers_;
  double map_index_ms_ = 0.0;  ///< To make the first of them.
};

}  // namespace glocal
