#include "evaluation/sharding/run_shard.hpp"

#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "evaluation/results/summary.hpp"
#include "evaluation/running/variant_run.hpp"
#include "glocal/error.hpp"

namespace glocal {
namespace {

/// Results of other files must not be put together.
void check_inputs(const Manifest& manifest, const PlannedVariant& planned, const Experiment& experiment,
                  const LoadedExperiment& loaded, const std::vector<std::filesystem::path>& plugins,
                  ExperimentLoader& loader) {
  if (identity_of(experiment, loaded.inputs, plugins, loader) == planned.identity) return;
  std::vector<Fault> faults;
  const std::string way_out =
      "since the first shard has run; bring it back as it was, or run all shards into another folder";
  for (const std::filesystem::path& input : loaded.inputs) {
    const auto known = manifest.inputs.find(input.string());
    if (known == manifest.inputs.end() || known->second != loader.hashes().of(input))
      faults.push_back({input.string(), 0, 0, "has changed " + way_out});
  }
  if (faults.empty()) faults.push_back({manifest.file, 0, 0, "reads other files " + way_out});
  throw ConfigError(std::move(faults));
}

}  // namespace

bool run_shard_trials(std::vector<Variant>& variants, const Manifest& manifest,
                      const std::vector<PlannedTrial>& trials, const Catalog& catalog,
                      const RunOptions& options, Journal& journal, const RunnerCallbacks& callbacks) {
  std::map<std::size_t, std::vector<std::size_t>> of_variants;
  for (const PlannedTrial& place : trials) of_variants[place.variant].push_back(place.trial);
  callbacks.counted(trials.size());
  const auto places = places_of(manifest);
  ExperimentLoader loader(catalog, callbacks.warn);
  for (const std::size_t i : loading_order(variants, catalog)) {
    Variant& variant = variants[i];
    const std::size_t place = places.at(variant.name);
    const auto of_variant = of_variants.find(place);
    if (of_variant == of_variants.end()) continue;
    if (callbacks.trials.stop()) return false;
    const PlannedVariant& planned = manifest.variants[place];
    VariantRun run(variant, loader, manifest.file, options);
    check_inputs(manifest, planned, variant.experiment, run.loaded(), options.plugins, loader);
    nlohmann::ordered_json description = run.description();
    journal.add_variant(planned.identity, description);
    callbacks.begin({planned.name, {}, variant.experiment, run.loaded(), {}, 0});
    const bool complete = run.run(planned.identity, of_variant->second, journal, callbacks.trials, true);
    // Once more, as memory has grown.
    description["peak_rss_mb"] = peak_rss_mb();
    journal.add_variant(planned.identity, description);
    if (!complete) return false;
  }
  return true;
}

}  // namespace glocal
