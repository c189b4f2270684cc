#include "sources/bags/file_bytes.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "glocal/error.hpp"

namespace glocal::bags {

void Place::refuse(std::size_t at, const std::string& message) const {
  std::string where = fmt::format("byte {}", offset + at);
  if (chunk) where += fmt::format(" of the unpacked chunk at byte {}", *chunk);
  if (record) where += fmt::format(" of message {}", *record);
  throw ConfigError(std::string(file), where + ": " + message);
}

FileBytes::FileBytes(const std::filesystem::path& file)
    : name_(file.string()), descriptor_(open(file.c_str(), O_RDONLY | O_CLOEXEC)) {
  if (descriptor_ < 0) throw ConfigError(name_, std::string("cannot be opened: ") + std::strerror(errno));
  struct stat status {};
  if (fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode)) {
    close(descriptor_);
    throw ConfigError(name_, "is no file that can be read piece by piece");
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

FileBytes::~FileBytes() {
  close(descriptor_);
}

std::string FileBytes::read(std::uint64_t offset, std::uint64_t n) const {
  if (offset > size_ || n > size_ - offset)
    refuse(offset, fmt::format("{} bytes are announced, the file ends before; get a fresh copy", n));
  std::string bytes(n, '\0');
  read_into(offset, bytes.data(), bytes.size());
  return bytes;
}

std::string_view FileBytes::peek(std::uint64_t offset) const {
  constexpr std::size_t most = 64, window = 1U << 14U;
  if (offset >= size_) return {};
  const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(most, size_ - offset));
  if (offset < window_offset_ || offset + wanted > window_offset_ + window_.size()) {
    window_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(window, size_ - offset)));
    read_into(offset, window_.data(), window_.size());
    window_offset_ = offset;
  }
  return std::string_view(window_).substr(static_cast<std::size_t>(offset - window_offset_), wanted);
}

void FileBytes::refuse(std::uint64_t offset, const std::string& message) const {
  Place{name_, offset}.refuse(0, message);
}

void FileBytes::read_into(std::uint64_t offset, char* bytes, std::size_t n) const {
  while (n > 0) {
    const ssize_t got = pread(descriptor_, bytes, n, static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) refuse(offset, std::string("cannot be read: ") + std::strerror(errno));
    if (got == 0) refuse(offset, "the file has become shorter while it was read");
    bytes += got;
    offset += static_cast<std::uint64_t>(got);
    n -= static_cast<std::size_t>(got);
  }
}

std::string_view FieldReader::take(std::uint64_t n) {
  if (n > bytes_.size() - at_)
    refuse(fmt::format("a field of {} bytes is announced where the record has {} left; get a fresh copy", n,
                       bytes_.size() - at_));
  const std::string_view taken = bytes_.substr(at_, static_cast<std::size_t>(n));
  at_ += taken.size();
  return taken;
}

}  // namespace glocal::bags
