// Fills described structs from a tree of nodes.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "config/node.hpp"
#include "glocal/params.hpp"
#include "glocal/registry.hpp"
#include "glocal/yaml.hpp"

namespace glocal {

/// Names the file in faults as given, and starts its relative paths from its folder.
[[nodiscard]] std::shared_ptr<const Origin> origin_of(const std::filesystem::path& file);

/// Fills the struct; appends a fault for everything that is not as described. Values that are refused or left
/// out stay as they were.
void read_params(const YamlNode& node, AnyParams& params, std::vector<Fault>& faults,
                 OtherKeys other_keys = OtherKeys::refused);

/// The names of a registry's strategies, sorted.
[[nodiscard]] std::vector<std::string> names_of(const RegistryBase& registry);

}  // namespace glocal
