// Large files, read piece by piece; and numbers in what was read.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "sources/clouds/scalar.hpp"

namespace glocal::bags {

/// Where bytes come from, for what is said about them.
struct Place {
  std::string_view file;
  std::uint64_t offset = 0;  ///< Of the first byte, in the file, the unpacked chunk or the record.
  std::optional<std::uint64_t> chunk = std::nullopt;  ///< Where in the file the chunk is that was unpacked.
  std::optional<std::int64_t> record = std::nullopt;  ///< Number of a database's record.

  /// Throws ConfigError about the byte `at` of these.
  [[noreturn]] void refuse(std::size_t at, const std::string& message) const;
};

/// A file of any size. Nothing of it is held but a small window.
class FileBytes {
 public:
  /// Throws ConfigError if the file cannot be opened.
  explicit FileBytes(const std::filesystem::path& file);
  ~FileBytes();
  FileBytes(const FileBytes&) = delete;
  FileBytes& operator=(const FileBytes&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// `n` bytes from `offset` on. Throws ConfigError if the file has less.
  [[nodiscard]] std::string read(std::uint64_t offset, std::uint64_t n) const;
  /// Up to 64 bytes from `offset` on, fewer at the end of the file; valid until the next call.
  [[nodiscard]] std::string_view peek(std::uint64_t offset) const;
  /// Throws ConfigError about the byte at `offset`.
  [[noreturn]] void refuse(std::uint64_t offset, const std::string& message) const;

 private:
  void read_into(std::uint64_t offset, char* bytes, std::size_t n) const;

  std::string name_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
  mutable std::string window_;
  mutable std::uint64_t window_offset_ = 0;
};

/// The little-endian fields of a record, one after the other. Whatever reaches beyond the record is refused.
class FieldReader {
 public:
  FieldReader(std::string_view bytes, const Place& place) : bytes_(bytes), place_(place) {}

  template <class T>
  [[nodiscard]] T number() {
    return clouds::number_at<T>(take(sizeof(T)).data(), std::endian::little);
  }
  /// Throws ConfigError if there are fewer.
  [[nodiscard]] std::string_view take(std::uint64_t n);
  /// A length of four bytes, and as many bytes.
  [[nodiscard]] std::string_view text() { return take(number<std::uint32_t>()); }
  [[nodiscard]] std::string_view rest() const { return bytes_.substr(at_); }
  [[nodiscard]] bool at_end() const { return at_ == bytes_.size(); }
  [[nodiscard]] std::size_t at() const { return at_; }
  [[noreturn]] void refuse(const std::string& message) const { place_.refuse(at_, message); }

 private:
  std::string_view bytes_;
  Place place_;
  std::size_t at_ = 0;
};

}  // namespace glocal::bags
