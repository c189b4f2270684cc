// A folder that appears whole or not at all.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <system_error>

#include "evaluation/results/file_lock.hpp"
#include "glocal/running_stage.hpp"

namespace glocal {

/// Files are written below a hidden name beside the final one, `.NAME.unfinished`; commit() syncs them and
/// renames the folder. Without commit() nothing stays, unless keep_unfinished() was called. A lock beside it,
/// `.NAME.lock`, keeps others out. Symbolic links are followed: they stay, and what they lead to is written.
/// Every failure throws RunError with the path and the reason.
class OutputFolder {
 public:
  /// Whether to go on with what an earlier run has left in a folder: in the final one, or in the hidden one.
  using TakesUp = std::function<bool(const std::filesystem::path& folder, bool is_final)>;

  /// Throws what the constructor would throw, but writes nothing: for what is known to be wrong
  /// to be said before anything is computed.
  static void check(
      const std::filesystem::path& path, bool replace,
      const TakesUp& takes_up = [](const std::filesystem::path&, bool) { return false; });

  /// Removes what a run that was killed at its very end has left beside its results.
  static void tidy(const std::filesystem::path& path);

  /// Throws ConfigError if `path` exists and is not an empty folder, unless `replace` is given and it holds
  /// results of an earlier run but none of the files `inputs`, and if another process writes there.
  /// `takes_up` is asked about an unfinished folder and about results at `path`; what it declines of the
  /// former is removed.
  OutputFolder(
      const std::filesystem::path& path, bool replace, const std::set<std::filesystem::path>& inputs = {},
      const TakesUp& takes_up = [](const std::filesystem::path&, bool) { return false; });
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Throws ConfigError if one of these files, too, would go with the results that are replaced.
  void spare(const std::set<std::filesystem::path>& inputs) const;

  [[nodiscard]] const std::filesystem::path& path() const { return places_.path; }
  /// Where the files are before commit().
  [[nodiscard]] const std::filesystem::path& unfinished() const { return places_.unfinished; }

  /// Appends to a file, which is made if there is none, with the folders above it. `name` is relative.
  void append(const std::filesystem::path& name, std::string_view content);
  /// Writes a file, in place of one that may be there: half of it is never to be seen under its name.
  void write(const std::filesystem::path& name, std::string_view content);
  /// Waits until all is on the disk that was written before.
  void sync();

  /// From now on the files stay, whatever happens, for a later run to take up.
  void keep_unfinished() { keeps_ = true; }
  void commit();

 private:
  struct Places {
    explicit Places(const std::filesystem::path& given);
    std::filesystem::path path, unfinished, lock;
    std::filesystem::path replaced;  ///< Where earlier results are while new ones take their place.
  };

  void restore_replaced() const;
  void take_up_or_begin(const std::set<std::filesystem::path>& inputs, const TakesUp& takes_up);
  void make_folder(const std::filesystem::path& folder, const std::filesystem::path& name);
  void check(const std::error_code& error, const std::filesystem::path& name = {}) const;
  void remove_replaced() const;

  Places places_;
  bool replace_;
  std::atomic<bool> keeps_ = false;  ///< Trials end in several threads.
  bool committed_ = false;
  std::set<std::filesystem::path> unsynced_;
  std::optional<FileLock> lock_;
  ProcessMark process_;  ///< That which may write.
};

}  // namespace glocal
