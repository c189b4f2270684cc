// Help for people at a terminal, and the same as data.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "glocal/catalog.hpp"

namespace glocal {

/// Every strategy of that name, of whatever kind; the keys of an experiment file for "experiment", and those
/// of a part of it for its path ("trials", "localizer.prior", "localizer.matcher.ransam"). None if there is
/// no such name.
[[nodiscard]] std::optional<std::string> help(std::string_view name, const Catalog& catalog);

/// The same as data: a list with an object for each; docs/file-formats.md tells the keys.
[[nodiscard]] std::optional<nlohmann::ordered_json> help_json(std::string_view name, const Catalog& catalog);

/// Kind, name, sentence, origin, status and motions of each strategy of a registry.
[[nodiscard]] nlohmann::ordered_json strategies_json(const RegistryBase& registry);

/// The strategies of one registry, a line each: name, status, sentence.
[[nodiscard]] std::string list_strategies(const RegistryBase& registry);

}  // namespace glocal
