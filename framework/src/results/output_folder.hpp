// A folder that appears whole or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace glocal {

/// Files are written below a temporary name beside the final one; commit() syncs them and renames the folder.
/// Without commit() nothing stays. Every failure throws RunError with the path and the reason.
class OutputFolder {
 public:
  /// Throws ConfigError if `path` exists and is not an empty folder, unless `replace` is given and it holds
  /// results of an earlier run.
  OutputFolder(const std::filesystem::path& path, bool replace);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  /// Appends to a file, which is made if there is none, with the folders above it. `name` is relative.
  void append(const std::filesystem::path& name, std::string_view content);
  void commit();

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
  bool replace_;
  bool committed_ = false;
};

}  // namespace glocal
