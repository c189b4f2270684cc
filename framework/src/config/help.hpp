// Help for people at a terminal.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "glocal/catalog.hpp"

namespace glocal {

/// Every strategy of that name, of whatever kind, or the keys of an experiment file for "experiment". None if
/// there is no such name.
[[nodiscard]] std::optional<std::string> help(std::string_view name, const Catalog& catalog);

/// The strategies of one registry, a line each.
[[nodiscard]] std::string list_strategies(const RegistryBase& registry);

}  // namespace glocal
