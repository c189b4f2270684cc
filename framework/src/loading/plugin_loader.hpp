// Loads strategies from outside.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "glocal/catalog.hpp"

namespace glocal {

/// Adds a plugin's strategies to a catalog; their origin is its name and version. A file that this catalog
/// has strategies of already is passed over. Plugins stay in memory to the program's end. Throws ConfigError,
/// naming the file and what to do, for whatever is no plugin or does not fit this program.
class PluginLoader {
 public:
  explicit PluginLoader(Catalog& catalog) : catalog_(catalog) {}

  void load(const std::filesystem::path& file);

  /// All files *.so of the folders in `path`, which are separated by colons; in the order of their names.
  void load_folders(const std::string& path);

  /// Absolute paths, in the order of loading.
  [[nodiscard]] const std::vector<std::filesystem::path>& loaded() const { return loaded_; }

 private:
  Catalog& catalog_;
  std::vector<std::filesystem::path> loaded_;
};

}  // namespace glocal
