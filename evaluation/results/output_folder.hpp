// A folder that appears whole or not at all.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <string_view>

#include "evaluation/results/file_lock.hpp"

namespace glocal {

/// Files are written below a hidden name beside the final one, `.NAME.unfinished`; commit() syncs them and
/// renames the folder. Without commit() nothing stays, unless keep_unfinished() was called. A lock beside it,
/// `.NAME.lock`, keeps others out. Every failure throws RunError with the path and the reason.
class OutputFolder {
 public:
  /// Whether to go on with what an earlier run has left in a folder.
  using TakesUp = std::function<bool(const std::filesystem::path& folder)>;

  /// Throws ConfigError if `path` exists and is not an empty folder, unless `replace` is given and it holds
  /// results of an earlier run, and if another process writes there. `takes_up` is asked about results at
  /// `path` and about an unfinished folder; what it declines of the latter is removed.
  OutputFolder(
      const std::filesystem::path& path, bool replace,
      const TakesUp& takes_up = [](const std::filesystem::path&) { return false; });
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Where the files are before commit().
  [[nodiscard]] const std::filesystem::path& unfinished() const { return unfinished_; }

  /// Appends to a file, which is made if there is none, with the folders above it. `name` is relative.
  void append(const std::filesystem::path& name, std::string_view content);
  /// Writes a file, in place of one that may be there: half of it is never to be seen under its name.
  void write(const std::filesystem::path& name, std::string_view content);

  /// From now on the files stay, whatever happens, for a later run to take up.
  void keep_unfinished() { keeps_ = true; }
  void commit();

 private:
  void restore_replaced() const;
  [[nodiscard]] std::filesystem::path beside(const char* what) const;

  std::filesystem::path path_;
  std::filesystem::path unfinished_;
  std::filesystem::path replaced_;  ///< Where earlier results are while new ones take their place.
  bool replace_;
  std::atomic<bool> keeps_ = false;  ///< Trials end in several threads.
  bool committed_ = false;
  std::optional<FileLock> lock_;
};

}  // namespace glocal
