#include "evaluation/results/file_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "glocal/error.hpp"

namespace glocal {
namespace {

[[noreturn]] void fail(const std::filesystem::path& shown) {
  throw RunError(fmt::format("{}: cannot write: {}", shown.string(), std::strerror(errno)));
}

/// Whether the open file is still the one of that name: its owner removes it before letting go of the lock.
bool is_current(int fd, const std::filesystem::path& file) {
  struct stat opened {};
  struct stat named {};
  return ::fstat(fd, &opened) == 0 && ::stat(file.c_str(), &named) == 0 && opened.st_ino == named.st_ino &&
         opened.st_dev == named.st_dev;
}

}  // namespace

FileLock::FileLock(std::filesystem::path file, const std::filesystem::path& shown) : file_(std::move(file)) {
  while (true) {
    fd_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (fd_ < 0) fail(shown);
    if (::flock(fd_, LOCK_EX | LOCK_NB) != 0) {
      const bool taken = errno == EWOULDBLOCK;
      ::close(fd_);
      if (!taken) fail(shown);
      throw ConfigError(shown,
                        "output: another run is writing this folder; wait for its end, or choose another "
                        "one with --out");
    }
    if (is_current(fd_, file_)) return;
    ::close(fd_);
  }
}

FileLock::~FileLock() {
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
  ::close(fd_);
}

}  // namespace glocal
