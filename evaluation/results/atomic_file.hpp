// Files that appear whole or not at all.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace glocal {

/// Files that belong together. They are written under temporary names beside the final ones; commit() renames
/// them in the order in which they were added. Without commit() nothing stays. Every failure to write throws
/// RunError with path and reason.
class AtomicFiles {
 public:
  /// Without `replace` files that are already there are refused.
  explicit AtomicFiles(bool replace) : replace_(replace) {}
  ~AtomicFiles();
  AtomicFiles(const AtomicFiles&) = delete;
  AtomicFiles& operator=(const AtomicFiles&) = delete;

  /// Throws ConfigError if a file exists and may not be replaced. Asked before anything is computed for it.
  void check(const std::filesystem::path& file) const { static_cast<void>(target_of(file)); }
  /// Writes a file under its temporary name. Folders above it are made. Throws as check() does.
  void add(const std::filesystem::path& file, std::string_view content);
  /// The same for a file that is written piece by piece: adds to the file that was added last.
  void append(std::string_view content);
  void commit();

 private:
  struct Pending {
    std::filesystem::path file;
    std::filesystem::path temporary;
  };
  /// Where it is written. Throws as check() does.
  [[nodiscard]] std::filesystem::path target_of(const std::filesystem::path& file) const;

  bool replace_;
  std::vector<Pending> pending_;
};

/// Writes a single file in the same way.
void write_file(const std::filesystem::path& file, std::string_view content, bool replace = true);

}  // namespace glocal
