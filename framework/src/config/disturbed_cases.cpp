#include "config/disturbed_cases.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "config/variants.hpp"
#include "glocal/words.hpp"

namespace glocal {
namespace {

struct Disturbance {
  std::string part;  ///< Of a case: "map" or "observations".
  YamlEntry kind;
  std::uint64_t level = 0;
};

std::vector<Disturbance> disturbances_of(const YamlNode& written, std::vector<Fault>& faults) {
  std::vector<Disturbance> all;
  if (written.kind != NodeKind::map) {
    add_fault(faults, written.place,
              "{}: expected `map: {{KIND: levels}}`, `observations: {{KIND: levels}}` or both, got {}",
              disturbances_key, name_of(written));
    return all;
  }
  for (const YamlEntry& part : written.entries) {
    if (part.key != "map" && part.key != "observations") {
      add_fault(faults, part.place, "{}: unknown key '{}'; there are map and observations", disturbances_key,
                shown(part.key));
      continue;
    }
    if (part.value.kind != NodeKind::map)
      add_fault(faults, part.value.place, "{}: {}: expected {{KIND: levels}}, got {}", disturbances_key,
                part.key, name_of(part.value));
    for (const YamlEntry& kind : part.value.entries) {
      for (const std::uint64_t level :
           numbers_of({std::make_shared<const YamlNode>(kind.value)}, disturbances_key, faults))
        all.push_back({part.key, kind, level});
    }
  }
  return all;
}

/// `disturbed: {source: SOURCE, by: [{kind: KIND, level: LEVEL}]}`; faults in it are told where the kind is
/// written.
YamlNode disturbed_source(YamlNode source, const Disturbance& by) {
  const Place& place = by.kind.place;
  const auto map = [&](std::vector<YamlEntry> entries) {
    YamlNode node = make_node(NodeKind::map, place);
    node.entries = std::move(entries);
    return node;
  };
  YamlNode list = make_node(NodeKind::list, place);
  list.items = {map({{"kind", place, make_scalar(place, by.kind.key)},
                     {"level", place, make_scalar(place, std::to_string(by.level))}})};
  return map({{"disturbed", place,
               map({{"source", source.place, std::move(source)}, {"by", place, std::move(list)}})}});
}

}  // namespace

void add_disturbed_cases(const YamlNode& written, std::vector<ExperimentPart>& cases,
                         std::vector<Fault>& faults) {
  if (cases.empty())
    add_fault(faults, written.place, "{}: there are no cases to disturb; name some", disturbances_key);
  const std::vector<Disturbance> all = disturbances_of(written, faults);
  std::vector<ExperimentPart> result;
  for (const ExperimentPart& one_case : cases) {
    result.push_back(one_case);
    result.back().is_fixed = false;  // It is one of several now.
    for (const Disturbance& by : all) {
      ExperimentPart disturbed = one_case;
      disturbed.is_fixed = false;
      disturbed.name = fmt::format("{}_{}-{}", one_case.name, by.kind.key, by.level);
      if (YamlEntry* source = find_entry(disturbed.tree, by.part)) {
        source->value = disturbed_source(std::move(source->value), by);
        result.push_back(std::move(disturbed));
      } else {
        add_fault(faults, one_case.place,
                  "{}: the case {} has no {} of its own; write it into the case, not into the experiment",
                  disturbances_key, one_case.name, by.part);
      }
    }
  }
  cases = std::move(result);
}

}  // namespace glocal
