// Strategies as users name them.
#pragma once

#include <string>
#include <vector>

#include "glocal/catalog.hpp"
#include "glocal/error.hpp"
#include "glocal/experiment.hpp"

namespace glocal {

/// The registry of a kind; null if there is none, of which unknown_kind() tells.
[[nodiscard]] const RegistryBase* registry_of(const std::string& kind, const Catalog& catalog);
[[nodiscard]] Fault unknown_kind(const std::string& kind, const Catalog& catalog);

/// A strategy with its parameters, of which the overrides change some. Throws ConfigError for what there is
/// not, and for values that are refused or missing.
[[nodiscard]] StrategyChoice chosen_strategy(const std::string& kind, const std::string& name,
                                             const std::vector<Override>& overrides, const Catalog& catalog);

}  // namespace glocal
