#include "evaluation/results/file_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <cerrno>
#include <utility>

#include "glocal/error.hpp"

namespace glocal {
namespace {

/// Whether the open file is still the one of that name: its owner removes it before letting go of the lock.
bool is_current(int fd, const std::filesystem::path& file) {
  struct stat opened {};
  struct stat named {};
  return ::fstat(fd, &opened) == 0 && ::stat(file.c_str(), &named) == 0 && opened.st_ino == named.st_ino &&
         opened.st_dev == named.st_dev;
}

}  // namespace

FileLock::FileLock(std::filesystem::path file, const std::filesystem::path& shown, IfTaken if_taken)
    : file_(std::move(file)) {
  while (true) {
    Descriptor lock(file_, O_RDWR | O_CREAT);
    if (lock.get() < 0) check_written(last_error(), shown);
    if (::flock(lock.get(), if_taken == IfTaken::wait ? LOCK_EX : LOCK_EX | LOCK_NB) != 0) {
      if (errno == EINTR) continue;
      if (errno != EWOULDBLOCK) check_written(last_error(), shown);
      throw ConfigError(shown,
                        "output: another run is writing this folder; wait for its end, or choose another "
                        "one with --out");
    }
    if (is_current(lock.get(), file_)) {
      lock_ = std::move(lock);
      return;
    }
  }
}

FileLock::~FileLock() {
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
}

}  // namespace glocal
