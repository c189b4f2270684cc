// One process at a time.
#pragma once

#include <filesystem>

#include "evaluation/results/file_io.hpp"

namespace glocal {

/// Holds a lock file, which is made for it and removed with it. The system lets go of the lock when a process
/// ends, however it ends.
class FileLock {
 public:
  enum class IfTaken { refuse, wait };
  /// If another process has the lock waits for it, or throws ConfigError naming `shown`. Throws RunError if
  /// there can be none.
  FileLock(std::filesystem::path file, const std::filesystem::path& shown,
           IfTaken if_taken = IfTaken::refuse);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  std::filesystem::path file_;
  Descriptor lock_;
};

}  // namespace glocal
