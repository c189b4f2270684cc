#include "config/text_file.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string_view>
#include <system_error>

namespace glocal {
namespace {

constexpr std::uintmax_t max_bytes = 1U << 20U;

/// Length of the UTF-8 sequence the bytes begin with; 0 if it is none (RFC 3629: no overlong forms, no
/// surrogates, at most U+10FFFF).
std::size_t utf8_length(std::string_view bytes) {
  const auto byte = [&](std::size_t i) {
    return i < bytes.size() ? static_cast<unsigned char>(bytes[i]) : 0U;
  };
  const auto follows = [&](std::size_t i, unsigned low = 0x80U, unsigned high = 0xBFU) {
    return byte(i) >= low && byte(i) <= high;
  };
  const unsigned first = byte(0);
  if (first < 0x80U) return 1;
  if (first >= 0xC2U && first <= 0xDFU) return follows(1) ? 2 : 0;
  if (first >= 0xE0U && first <= 0xEFU) {
    const bool second = follows(1, first == 0xE0U ? 0xA0U : 0x80U, first == 0xEDU ? 0x9FU : 0xBFU);
    return second && follows(2) ? 3 : 0;
  }
  if (first >= 0xF0U && first <= 0xF4U) {
    const bool second = follows(1, first == 0xF0U ? 0x90U : 0x80U, first == 0xF4U ? 0x8FU : 0xBFU);
    return second && follows(2) && follows(3) ? 4 : 0;
  }
  return 0;
}

bool is_control(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (byte < 0x20U && c != '\t' && c != '\n' && c != '\r') || byte == 0x7FU;
}

}  // namespace

std::optional<std::string> why_unreadable(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (status.type() == std::filesystem::file_type::not_found) return "no such file: " + file.string();
  if (error) return "cannot be reached: " + file.string() + ": " + error.message();
  if (std::filesystem::is_directory(status)) return "is a folder, not a file: " + file.string();
  if (!std::filesystem::is_regular_file(status)) return "is not a regular file: " + file.string();
  errno = 0;
  if (!std::ifstream(file, std::ios::binary)) {
    return "cannot be opened: " + file.string() + ": " + std::strerror(errno);
  }
  return std::nullopt;
}

std::string read_text_file(const std::filesystem::path& file) {
  if (const auto why = why_unreadable(file)) throw ConfigError(file, *why);
  std::ifstream stream(file, std::ios::binary);
  std::string bytes;
  std::array<char, 4096> chunk{};
  while (bytes.size() <= max_bytes && (stream.read(chunk.data(), chunk.size()), stream.gcount() > 0))
    bytes.append(chunk.data(), static_cast<std::size_t>(stream.gcount()));
  if (stream.bad()) throw ConfigError(file, "cannot be read: " + file.string());
  if (bytes.size() > max_bytes) throw ConfigError(file, "is larger than 1 MiB: not a configuration file");
  return bytes;
}

std::optional<Fault> find_binary(const std::string& bytes, const Origin& origin) {
  int line = 1;
  std::size_t line_start = 0;
  std::size_t i = 0;
  while (i < bytes.size()) {
    const std::size_t length = utf8_length(std::string_view(bytes).substr(i));
    if (length == 0 || is_control(bytes[i])) {
      const std::string what = length == 0 ? "is not UTF-8 text" : "has a control character (a binary file?)";
      return Fault{origin.label, line, static_cast<int>(i - line_start) + 1, "the file " + what};
    }
    if (bytes[i] == '\n') {
      ++line;
      line_start = i + 1;
    }
    i += length;
  }
  return std::nullopt;
}

}  // namespace glocal
