// Words that come from files (names, fields, keys), as messages show them: whatever a file brings, a terminal
// only ever prints it.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace glocal {

/// How many bytes the character has that a text begins with; 0 if they are no UTF-8 (RFC 3629: no overlong
/// forms, no surrogates, at most U+10FFFF). The text is not empty.
[[nodiscard]] std::size_t utf8_length(std::string_view text);

/// A text without the mark that some programs write before UTF-8.
[[nodiscard]] std::string_view without_byte_order_mark(std::string_view text);

/// The text with control characters as \u001b and bytes that are no UTF-8 as U+FFFD. Newlines and tabs stay.
[[nodiscard]] std::string printable(std::string_view text);

/// A word in a message: printable, without newlines and tabs, and of more than 80 characters the middle is
/// left out.
[[nodiscard]] std::string shown(std::string_view word);

/// Of longer lists the rest is counted.
inline constexpr std::size_t most_listed = 20;

/// "a, b, c": each as shown(); behind the 20th stands how many more there are.
template <class Words>
[[nodiscard]] std::string listed(const Words& words, std::string_view between = ", ") {
  std::string list;
  std::size_t n = 0;
  for (const auto& word : words) {
    if (n++ >= most_listed) continue;
    if (n > 1) list += between;
    list += shown(word);
  }
  return n > most_listed ? list + " and " + std::to_string(n - most_listed) + " more" : list;
}

/// The first 20 of these texts; of more, one that says how many there are.
[[nodiscard]] std::vector<std::string> first_of(std::vector<std::string> texts);

/// A whole message: printable, and of lines of more than 2,000 characters the middle is left out.
[[nodiscard]] std::string fit_message(std::string_view text);

}  // namespace glocal
