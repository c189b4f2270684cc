#include "evaluation/comparison/run_part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "evaluation/results/json_text.hpp"
#include "glocal/error.hpp"

namespace glocal {
namespace {

using Json = nlohmann::ordered_json;

CaseRole role_of(const std::string& name) {
  constexpr std::array<CaseRole, 3> all = {CaseRole::none, CaseRole::choose, CaseRole::judge};
  const auto* const role =
      std::find_if(all.begin(), all.end(), [&](CaseRole r) { return name == to_string(r); });
  if (role == all.end()) throw std::invalid_argument("there is no role '" + name + "'");
  return *role;
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

}  // namespace glocal
