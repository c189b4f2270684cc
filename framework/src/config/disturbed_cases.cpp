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

Fault fault_of(const Place& place, const std::string& message) {
  return fault_at(place, fmt::format("{}: {}", disturbances_key, message));
}

std::vector<Disturbance> disturbances_of(const YamlNode& written, std::vector<Fault>& faults) {
  std::vector<Disturbance> all;
  if (written.kind != NodeKind::map) {
    faults.push_back(fault_of(
        written.place,
        "expected `map: {KIND: levels}`, `observations: {KIND: levels}` or both, got " + name_of(written)));
    return all;
  }
  for (const YamlEntry& part : written.entries) {
    if (part.key != "map" && part.key != "observations") {
      faults.push_back(fault_of(
          part.place, fmt::format("unknown key '{}'; there are map and observations", shown(part.key))));
      continue;
    }
    if (part.value.kind != NodeKind::map)
      faults.push_back(fault_of(part.value.place, fmt::format("{}: expected {{KIND: levels}}, got {}",
                                                              part.key, name_of(part.value))));
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
  const auto scalar = [&](std::string text) {
    YamlNode node = make_node(NodeKind::scalar, place);
    node.text = std::move(text);
    return node;
  };
  const auto map = [&](std::vector<YamlEntry> entries) {
    YamlNode node = make_node(NodeKind::map, place);
    node.entries = std::move(entries);
    return node;
  };
  YamlNode list = make_node(NodeKind::list, place);
  list.items = {
      map({{"kind", place, scalar(by.kind.key)}, {"level", place, scalar(std::to_string(by.level))}})};
  return map({{"disturbed", place,
               map({{"source", source.place, std::move(source)}, {"by", place, std::move(list)}})}});
}

}  // namespace

void add_disturbed_cases(const YamlNode& written, std::vector<ExperimentPart>& cases,
                         std::vector<Fault>& faults) {
  if (cases.empty()) faults.push_back(fault_of(written.place, "there are no cases to disturb; name some"));
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
        faults.push_back(
            fault_of(one_case.place,
                     fmt::format("the case {} has no {} of its own; write it into the case, not into the "
                                 "experiment",
                                 one_case.name, by.part)));
      }
    }
  }
  cases = std::move(result);
}

}  // namespace glocal
