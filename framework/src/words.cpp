#include "glocal/words.hpp"

#include <fmt/format.h>

#include <cstdint>

namespace glocal {
namespace {

/// The first character of a text: how many bytes it has, and its code point. A byte that begins none in UTF-8
/// (RFC 3629) is U+FFFD.
struct Character {
  std::size_t bytes = 1;
  char32_t code = U'\uFFFD';
};

Character first_character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t first = byte(0);
  if (first < 0x80) return {1, first};
  const std::size_t bytes = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  constexpr std::uint8_t least_leader = 0xC2, largest_leader = 0xF4;
  if (first < least_leader || first > largest_leader || text.size() < bytes) return {};
  char32_t code = first & (0x7FU >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return {};
    code = code << 6U | (byte(i) & 0x3FU);
  }
  const bool is_surrogate = code >= 0xD800 && code <= 0xDFFF;
  const bool is_too_long = code < (bytes == 4 ? 0x10000U : bytes == 3 ? 0x800U : 0x80U);
  if (is_surrogate || is_too_long || code > 0x10FFFF) return {};
  return {bytes, code};
}

/// Those that terminals act upon: C0, DEL and C1; and those that turn the direction of what follows.
bool is_control(char32_t code) {
  return code < 0x20 || (code >= 0x7F && code < 0xA0) || (code >= 0x202A && code <= 0x202E) ||
         (code >= 0x2066 && code <= 0x2069);
}

std::string escaped(std::string_view text, bool keep_lines) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const auto [bytes, code] = first_character(text);
    const bool is_kept = keep_lines && (code == U'\n' || code == U'\t');
    if (is_control(code) && !is_kept) {
      result += fmt::format("\\u{:04x}", static_cast<std::uint32_t>(code));
    } else {
      result += code == U'\uFFFD' ? "\uFFFD" : text.substr(0, bytes);
    }
    text.remove_prefix(bytes);
  }
  return result;
}

bool continues_character(char byte) {
  return (static_cast<std::uint8_t>(byte) & 0xC0U) == 0x80U;
}

/// Of a text in UTF-8 that is longer, the first two thirds and the last third of `most` bytes.
std::string without_middle(std::string_view text, std::size_t most) {
  if (text.size() <= most) return std::string(text);
  std::size_t head = most * 2 / 3, tail = text.size() - most / 3;
  while (head > 0 && continues_character(text[head])) --head;
  while (tail < text.size() && continues_character(text[tail])) ++tail;
  return fmt::format("{}…{}", text.substr(0, head), text.substr(tail));
}

}  // namespace

std::size_t utf8_length(std::string_view text) {
  const auto [bytes, code] = first_character(text);
  // U+FFFD itself has three.
  return bytes == 1 && code == U'\uFFFD' ? 0 : bytes;
}

std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view mark = "\xEF\xBB\xBF";
  if (text.starts_with(mark)) text.remove_prefix(mark.size());
  return text;
}

std::string printable(std::string_view text) {
  return escaped(text, true);
}

std::string shown(std::string_view word) {
  constexpr std::size_t longest = 80;
  // What is left out need not be escaped: a name may have megabytes.
  return without_middle(escaped(without_middle(word, 16 * longest), false), longest);
}

std::vector<std::string> first_of(std::vector<std::string> texts) {
  if (texts.size() <= most_listed) return texts;
  const std::size_t more = texts.size() - most_listed;
  texts.resize(most_listed);
  texts.push_back(fmt::format("and {} more like these", more));
  return texts;
}

std::string fit_message(std::string_view text) {
  constexpr std::size_t longest_line = 2000;
  std::string result;
  while (true) {
    const std::size_t end = text.find('\n');
    result += without_middle(printable(without_middle(text.substr(0, end), 16 * longest_line)), longest_line);
    if (end == std::string_view::npos) return result;
    result += '\n';
    text.remove_prefix(end + 1);
  }
}

}  // namespace glocal
