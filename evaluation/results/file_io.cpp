#include "evaluation/results/file_io.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <utility>

#include "glocal/error.hpp"

namespace glocal {
namespace {

[[noreturn]] void fail_with_errno(const std::filesystem::path& path) {
  throw RunError(fmt::format("{}: cannot write: {}", path.string(), std::strerror(errno)));
}

/// Closes a file descriptor.
class Descriptor {
 public:
  Descriptor(const std::filesystem::path& path, int flags, const std::filesystem::path& shown)
      : fd_(::open(path.c_str(), flags | O_CLOEXEC, 0644)) {
    if (fd_ < 0) fail_with_errno(shown);
  }
  ~Descriptor() { ::close(fd_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_;
};

}  // namespace

std::string content_of(const std::filesystem::path& file) {
  std::ostringstream content;
  content << std::ifstream(file, std::ios::binary).rdbuf();
  return std::move(content).str();
}

void append_to_file(const std::filesystem::path& file, std::string_view content,
                    const std::filesystem::path& shown) {
  const Descriptor out(file, O_WRONLY | O_CREAT | O_APPEND, shown);
  while (!content.empty()) {
    const ssize_t written = ::write(out.get(), content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail_with_errno(shown);
    content.remove_prefix(static_cast<std::size_t>(written));
  }
}

void sync_to_disk(const std::filesystem::path& path) {
  const Descriptor file(path, O_RDONLY, path);
  if (::fsync(file.get()) != 0) fail_with_errno(path);
}

}  // namespace glocal
