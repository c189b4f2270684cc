// Loads strategies from outside.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
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

  /// Files with this extension (".py") are no shared objects: `load` adds their strategies, whose origin is
  /// the file's name. Throws what load() throws.
  using LoadOther = std::function<void(const std::filesystem::path& file, Catalog& catalog)>;
  void hand_over(std::string extension, LoadOther load) { others_[std::move(extension)] = std::move(load); }

  /// All files *.so of the folders in `path`, which are separated by colons; in the order of their names.
  void load_folders(const std::string& path);

  /// Absolute paths, in the order of loading.
  [[nodiscard]] const std::vector<std::filesystem::path>& loaded() const { return loaded_; }
  /// The same for an experiment that is written: whoever reads it must do without other ways to name plugins.
  [[nodiscard]] std::vector<FilePath> named() const;

 private:
  Catalog& catalog_;
  std::map<std::string, LoadOther> others_;  ///< By extension.
  std::vector<std::filesystem::path> loaded_;
};

}  // namespace glocal
