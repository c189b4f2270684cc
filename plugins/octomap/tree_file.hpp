// Octrees as files.
#pragma once

#include <octomap/OcTree.h>

#include <filesystem>
#include <memory>
#include <string>

namespace glocal::octomap_plugin {

/// Reads a .bt (binary) or .ot (with probabilities) file of an OcTree, known by its content. Throws
/// ConfigError for what is none, or is damaged.
[[nodiscard]] std::unique_ptr<octomap::OcTree> read_tree(const std::filesystem::path& file);

/// The content of a .bt file: each node occupied, free or unknown.
[[nodiscard]] std::string bt_file(const octomap::OcTree& tree);

}  // namespace glocal::octomap_plugin
