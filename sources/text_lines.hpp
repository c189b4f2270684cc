// Text files of numbers: line by line, field by field.
#pragma once

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <optional>
#include <string_view>
#include <vector>

#include "glocal/words.hpp"

namespace glocal {

/// The fields of a line; blanks, tabs and carriage returns part them.
void split_fields(std::string_view line, std::vector<std::string_view>& fields);

/// The number that a field is, perhaps infinite or NaN; one too small for a double is 0. None if it is no
/// number, or too large.
[[nodiscard]] std::optional<double> number_in(std::string_view field);
/// The number, without a sign or decimals, that a field is.
[[nodiscard]] std::optional<std::size_t> whole_number_in(std::string_view field);

/// The value of an enum that a word is the name of; `names` has one for each value, in their order, perhaps
/// not of the last ones. None if the word is no name.
template <class Enum>
[[nodiscard]] std::optional<Enum> value_named(std::string_view word,
                                              std::initializer_list<std::string_view> names) {
  const auto* const at = std::ranges::find(names, word);
  if (at == names.end()) return std::nullopt;
  return static_cast<Enum>(at - names.begin());
}

/// The lines of a text, which must outlive this.
class TextLines {
 public:
  explicit TextLines(std::string_view text) : rest_(without_byte_order_mark(text)) {}

  /// Goes to the next line; false at the end of the text.
  bool next();
  /// Goes to the next line that has fields.
  bool next_with_fields();

  [[nodiscard]] const std::vector<std::string_view>& fields() const { return fields_; }
  /// Of the line at hand, from 1.
  [[nodiscard]] int number() const { return number_; }
  /// All behind the line at hand.
  [[nodiscard]] std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
  std::vector<std::string_view> fields_;
  int number_ = 0;
};

}  // namespace glocal
