#include "config/text_file.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string_view>
#include <system_error>

#include "glocal/words.hpp"

namespace glocal {
namespace {

constexpr std::uintmax_t max_bytes = 1U << 20U;

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
