// Whole files: read, and written to disk for good.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace glocal {

/// Closes a file descriptor.
class Descriptor {
 public:
  Descriptor() = default;
  /// Negative if the file could not be opened, of which last_error() tells.
  Descriptor(const std::filesystem::path& path, int flags);
  ~Descriptor();
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_ = -1;
};

/// The bytes of a file; empty if it cannot be read.
[[nodiscard]] std::string content_of(const std::filesystem::path& file);

/// Appends to a file, which is made if there is none.
[[nodiscard]] std::error_code append_to_file(const std::filesystem::path& file, std::string_view content);

/// Writes all of it to an open file, whatever interrupts.
[[nodiscard]] std::error_code write_all(int descriptor, std::string_view content);

/// Makes a folder and those above it. `changed` are those that have a new entry, to be synced.
[[nodiscard]] std::error_code make_folders(const std::filesystem::path& folder,
                                           std::vector<std::filesystem::path>& changed);

/// The same for the folders above a file, which are synced. Throws RunError with the file and the reason.
void make_folders_above(const std::filesystem::path& file);

/// Waits until a file or folder is on the disk: of a file what is in it, of a folder the names in it.
[[nodiscard]] std::error_code sync_to_disk(const std::filesystem::path& path);

/// Waits until all is on the disk that was written to the file system of this folder, by any program.
[[nodiscard]] std::error_code sync_file_system(const std::filesystem::path& folder);

/// That of the system call that has failed just now.
[[nodiscard]] std::error_code last_error();

/// Why a file could not be written, for a message.
[[nodiscard]] std::string reason_of(const std::error_code& error);

/// Throws RunError with the file and the reason if it could not be written.
void check_written(const std::error_code& error, const std::filesystem::path& file);

/// Where this is once all symbolic links are followed, also where nothing is there yet. Throws ConfigError if
/// links lead in a circle.
[[nodiscard]] std::filesystem::path without_links(const std::filesystem::path& path);

}  // namespace glocal
