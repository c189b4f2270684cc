#include "evaluation/sharding/manifest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <stdexcept>
#include <utility>

#include "config/text_file.hpp"
#include "config/variants.hpp"
#include "evaluation/results/atomic_file.hpp"
#include "evaluation/results/file_io.hpp"
#include "evaluation/results/json_text.hpp"
#include "evaluation/running/trials.hpp"
#include "glocal/error.hpp"

namespace glocal {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int manifest_format = 2;

using Values = std::map<std::string, std::string>;

/// All that results follow from, but for what is in files: threads change nothing, and plugins count by what
/// is in them.
std::string text_of(Experiment experiment, const Catalog& catalog) {
  experiment.threads = 1;
  experiment.plugins.clear();
  return effective_yaml(experiment, catalog);
}

Values values_of(const Experiment& experiment, const Catalog& catalog) {
  Values values;
  for (const auto& [path, setting] : settings_of(text_of(experiment, catalog), "effective.yaml", {}))
    values[path] = setting.text;
  return values;
}

/// What differs from the first variant's values, as a merge patch: null for what is not there.
Json to_json(const Values& values, const Values& first) {
  Json json = Json::object();
  for (const auto& [path, text] : values) {
    const auto other = first.find(path);
    if (other == first.end() || other->second != text) json[path] = text;
  }
  for (const auto& [path, text] : first) {
    if (!values.contains(path)) json[path] = nullptr;
  }
  return json;
}

std::vector<std::size_t> whole_numbers(const Json& array) {
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < array.size(); ++i) numbers.push_back(whole_number(array, i));
  return numbers;
}

PlannedStarts starts_of(const Json& json) {
  PlannedStarts starts{whole_numbers(json.at("samples")), whole_numbers(json.at("steps"))};
  if (starts.samples.size() != starts.steps.size())
    throw std::invalid_argument("there are not as many steps as samples");
  return starts;
}

Json to_json(const Manifest& manifest) {
  Json starts = Json::array();
  for (const auto& list : manifest.starts)
    starts.push_back({{"samples", list.samples}, {"steps", list.steps}});
  Json variants = Json::array();
  const auto& first = manifest.variants.front().values;
  for (const PlannedVariant& v : manifest.variants) {
    variants.push_back({{"name", v.name},
                        {"identity", v.identity},
                        {"text", v.text},
                        {"values", to_json(v.values, first)},
                        {"starts", v.starts},
                        {"origin", v.origin}});
  }
  return {{"format", manifest_format},
          {"experiment", manifest.experiment},
          {"file", manifest.file},
          {"program", manifest.program},
          {"plugins_sha256", manifest.plugins},
          {"inputs_sha256", manifest.inputs},
          {"values", first},
          {"starts", std::move(starts)},
          {"variants", std::move(variants)}};
}

Manifest manifest_of(const Json& json) {
  Manifest manifest{json.at("experiment"),
                    json.at("file"),
                    json.at("program"),
                    json.at("plugins_sha256"),
                    json.at("inputs_sha256"),
                    {},
                    {}};
  for (const Json& list : json.at("starts")) manifest.starts.push_back(starts_of(list));
  const Json first = json.at("values").get<Values>();
  for (const Json& v : json.at("variants")) {
    Json values = first;
    values.merge_patch(v.at("values"));
    manifest.variants.push_back(
        {v.at("name"), v.at("identity"), v.at("text"), values, whole_number(v, "starts"), v.at("origin")});
    const PlannedVariant& variant = manifest.variants.back();
    static_cast<void>(manifest.starts.at(variant.starts));
    if (!variant.name.empty() && !is_folder_name(variant.name))
      throw std::invalid_argument("no name of a variant: " + variant.name);
  }
  if (!manifest.program.is_object()) throw std::invalid_argument("it does not tell the program");
  if (manifest.variants.empty()) throw std::invalid_argument("it has no variants");
  return manifest;
}

PlannedStarts planned_starts(const LoadedExperiment& loaded, const TrialsConfig& trials) {
  PlannedStarts starts{loaded.starts, {}};
  for (const std::size_t start : loaded.starts)
    starts.steps.push_back(steps_left(loaded.drive, trials, start));
  return starts;
}

/// Which of the lists this one is; it is added if it is new.
std::size_t place_of(PlannedStarts starts, std::vector<PlannedStarts>& lists) {
  const auto same = std::find(lists.begin(), lists.end(), starts);
  const auto place = static_cast<std::size_t>(same - lists.begin());
  if (same == lists.end()) lists.push_back(std::move(starts));
  return place;
}

/// Its values without the seed: whether a localizer can be made of them does not hang on it.
std::string values_without_seed(const PlannedVariant& variant) {
  std::string text;
  for (const auto& [path, value] : variant.values) {
    if (path != "seed") text += fmt::format("{}={}\n", path, value);
  }
  return text;
}

/// "localizer.matcher.ransam.iterations is 50000 there and 200000 here", of a few values.
std::string difference(const Values& there, const Values& here) {
  constexpr std::size_t most = 5;
  std::set<std::string> paths;
  for (const auto& [path, text] : there) paths.insert(path);
  for (const auto& [path, text] : here) paths.insert(path);
  const auto text_in = [](const Values& values, const std::string& path) {
    const auto found = values.find(path);
    return found == values.end() ? std::string("not given") : found->second;
  };
  std::string text;
  std::size_t n = 0;
  for (const std::string& path : paths) {
    const std::string then = text_in(there, path);
    const std::string now = text_in(here, path);
    if (then == now || ++n > most) continue;
    text += fmt::format("{}{} is {} there and {} here", n == 1 ? "" : ", ", path, then, now);
  }
  return n > most ? fmt::format("{}, and {} more", text, n - most) : text;
}

}  // namespace

std::map<std::string, std::size_t> places_of(const Manifest& manifest) {
  std::map<std::string, std::size_t> places;
  for (std::size_t i = 0; i < manifest.variants.size(); ++i) places[manifest.variants[i].name] = i;
  return places;
}

std::vector<std::vector<std::size_t>> steps_of(const Manifest& manifest) {
  std::vector<std::vector<std::size_t>> steps;
  for (std::size_t v = 0; v < manifest.variants.size(); ++v) steps.push_back(manifest.starts_of(v).steps);
  return steps;
}

std::size_t Manifest::count_trials() const {
  std::size_t n = 0;
  for (const PlannedVariant& variant : variants) n += starts[variant.starts].samples.size();
  return n;
}

fs::path manifest_file(const fs::path& shared) {
  return shared / shards_folder / "manifest.json";
}

fs::path journals_folder(const fs::path& shared) {
  return shared / shards_folder / "journals";
}

bool is_shared_folder(const fs::path& folder) {
  std::error_code unreachable;
  return fs::exists(manifest_file(folder), unreachable);
}

std::string identity_of(const Experiment& experiment, const std::set<fs::path>& inputs,
                        const std::vector<fs::path>& plugins, ExperimentLoader& loader) {
  FileHashes& hashes = loader.hashes();
  std::map<std::string, std::string> by_name;
  std::set<std::string> contents;
  for (const fs::path& input : inputs) {
    by_name[input.string()] = hashes.of(input);
    contents.insert(hashes.of(input));
  }
  for (const fs::path& plugin : plugins) contents.insert(hashes.of(plugin));
  std::string text;
  for (const auto& [path, setting] :
       settings_of(text_of(experiment, loader.catalog()), "effective.yaml", by_name))
    text += path + "=" + setting.identity + "\n";
  for (const std::string& content : contents) text += content + "\n";
  return sha256_of_text(text);
}

Manifest sketch_of(const std::vector<Variant>& variants, const fs::path& file,
                   const std::vector<fs::path>& plugins, const Catalog& catalog, FileHashes& hashes) {
  Manifest manifest;
  manifest.experiment = variants.front().experiment.name;
  if (!file.empty()) manifest.file = fs::absolute(file).string();
  manifest.program = program_identity(hashes);
  for (const fs::path& plugin : plugins) manifest.plugins[plugin.string()] = hashes.of(plugin);
  for (const Variant& variant : variants) {
    PlannedVariant planned;
    planned.name = variant.name;
    planned.text = sha256_of_text(text_of(variant.experiment, catalog));
    planned.origin = origin_json(variant);
    manifest.variants.push_back(std::move(planned));
  }
  return manifest;
}

Manifest plan(std::vector<Variant>& variants, const fs::path& file, const std::vector<fs::path>& plugins,
              ExperimentLoader& loader) {
  const Catalog& catalog = loader.catalog();
  FileHashes& hashes = loader.hashes();
  Manifest manifest = sketch_of(variants, file, plugins, catalog, hashes);
  std::map<std::string, std::set<fs::path>> of_stages;  // Files that stages of these values read.
  for_each_loaded(variants, loader, [&](std::size_t i, LoadedExperiment& loaded) {
    Experiment& experiment = variants[i].experiment;
    PlannedVariant& planned = manifest.variants[i];
    planned.values = values_of(experiment, catalog);
    const auto [known, is_new] = of_stages.try_emplace(values_without_seed(planned));
    if (is_new) {
      static_cast<void>(make_localizer(experiment, catalog, loaded));
      known->second = loaded.inputs;
    }
    std::set<fs::path> inputs = loaded.inputs;
    inputs.insert(known->second.begin(), known->second.end());
    for (const fs::path& input : inputs) manifest.inputs[input.string()] = hashes.of(input);
    planned.identity = identity_of(experiment, inputs, plugins, loader);
    planned.starts = place_of(planned_starts(loaded, experiment.trials), manifest.starts);
  });
  return manifest;
}

std::vector<Fault> differences(const Manifest& there, const Manifest& here,
                               const std::vector<Variant>& variants, const Catalog& catalog,
                               const fs::path& shared) {
  constexpr std::size_t most = 10;
  std::vector<Fault> faults;
  const auto differ = [&](const std::string& what) {
    faults.push_back({shared.string(), 0, 0,
                      fmt::format("output: the folder was made otherwise: {}; choose another folder with "
                                  "--out, or give what it was made with",
                                  what)});
  };
  if (there.program != here.program)
    differ(fmt::format("by another build of the program ({} there, {} here)",
                       there.program.value("revision", ""), here.program.value("revision", "")));
  if (there.plugins != here.plugins) differ("with other plugins, or other versions of them");
  const auto places = places_of(here);
  for (const PlannedVariant& planned : there.variants) {
    if (faults.size() > most) break;
    const auto place = places.find(planned.name);
    if (place == places.end()) {
      differ(planned.name.empty() ? "from an experiment without variants"
                                  : fmt::format("with a variant '{}', which is not here", planned.name));
    } else if (here.variants[place->second].text != planned.text) {
      const std::string of = planned.name.empty() ? "" : fmt::format("variant '{}': ", planned.name);
      differ(of + difference(planned.values, values_of(variants[place->second].experiment, catalog)));
    } else if (here.variants[place->second].origin != planned.origin) {
      differ(fmt::format("with the variant '{}' as another setting or case", planned.name));
    }
  }
  return faults;
}

bool has_more_variants(const Manifest& there, const Manifest& here) {
  const auto places = places_of(there);
  return std::any_of(here.variants.begin(), here.variants.end(),
                     [&](const PlannedVariant& v) { return !places.contains(v.name); });
}

void write_manifest(const fs::path& shared, const Manifest& manifest) {
  write_file(manifest_file(shared), json_text(to_json(manifest), 1) + "\n");
}

Manifest read_manifest(const fs::path& shared) {
  const fs::path file = manifest_file(shared);
  if (!is_shared_folder(shared))
    throw ConfigError(shared,
                      "no shards have run here: there is no .shards/manifest.json; name the folder that "
                      "'glocal run --shard' was given with --out");
  if (const auto why = why_unreadable(file)) throw ConfigError(file, "cannot be read: " + *why);
  try {
    const Json json = parse_json(content_of(file));
    if (json.at("format") == manifest_format) return manifest_of(json);
  } catch (const std::exception& error) {
    throw ConfigError(
        file,
        fmt::format("is damaged ({}); remove it and run a shard again, which writes it anew", reason(error)));
  }
  throw ConfigError(file, "is of another version of glocal; give shards of this one another folder");
}

}  // namespace glocal
