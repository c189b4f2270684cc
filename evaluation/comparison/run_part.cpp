#include "evaluation/comparison/run_part.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "evaluation/results/json_text.hpp"
#include "glocal/error.hpp"

namespace glocal {
namespace {

using Json = nlohmann::ordered_json;

CaseRole role_of(const std::string& name) {
  for (const CaseRole role : {CaseRole::none, CaseRole::choose, CaseRole::judge}) {
    if (name == to_string(role)) return role;
  }
  throw std::invalid_argument("there is no role '" + name + "'");
}

RunPart read_part(const Json& json) {
  RunPart part{.setting = json.at("setting"),
               .case_name = json.at("case"),
               .role = role_of(json.at("role")),
               .seed = whole_number(json, "seed"),
               .values = {}};
  for (const auto& [path, value] : json.at("values").items()) part.values.emplace_back(path, value);
  return part;
}

/// A path below the localizer at which two runs have other values, if there is one.
std::optional<std::string> difference_of_methods(const StoredRun& a, const StoredRun& b) {
  for (const auto& [one, other] : {std::pair(&a.settings, &b.settings), {&b.settings, &a.settings}}) {
    for (const auto& [path, setting] : *one) {
      if (!path.starts_with("localizer.")) continue;
      const auto found = other->find(path);
      if (found == other->end() || found->second.identity != setting.identity) return path;
    }
  }
  return std::nullopt;
}

}  // namespace

void refuse_provenance(const NamedRun& run, const std::string& what) {
  throw ConfigError(run.results.folder / "provenance.json", what);
}

std::optional<RunPart> part_of(const NamedRun& run) {
  const Json& provenance = run.results.provenance;
  const auto part = provenance.is_object() ? provenance.find("variant") : provenance.end();
  if (part == provenance.end()) return std::nullopt;
  try {
    return read_part(*part);
  } catch (const std::exception& error) {
    refuse_provenance(
        run, fmt::format("is not as glocal run leaves it ({}); run the experiment again with this version",
                         reason(error)));
  }
}

void PooledParts::add(const std::filesystem::path& folder, const RunPart& part, const NamedRun& run) {
  const SettingId setting(folder, part.setting);
  const auto [other, is_new] = runs_.try_emplace({setting, part.case_name, part.seed}, &run);
  if (!is_new)
    refuse_provenance(run, fmt::format("is of the same setting, case and seed as {}; leave one of them out",
                                       other->second->name));
  const NamedRun& first = *first_of_.try_emplace(setting, &run).first->second;
  if (const auto path = difference_of_methods(first.results, run.results))
    refuse_provenance(run, fmt::format("has another {} than {}, and both are of the setting '{}'; leave one "
                                       "of them out",
                                       *path, first.name, part.setting));
}

}  // namespace glocal
