// Reports as text for a terminal, and as Markdown.
#pragma once

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

namespace glocal {

/// A report is a list of these, whichever way it is written.
struct Heading {
  std::string text;
};
struct Paragraph {
  std::string text;
};
struct List {
  std::vector<std::string> items;
};
/// Columns hold names first, then numbers.
struct Table {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};
using Block = std::variant<Heading, Paragraph, List, Table>;
using Report = std::vector<Block>;

/// Lines of at most 110 letters, but for tables.
[[nodiscard]] std::string as_text(const Report& report);
[[nodiscard]] std::string as_markdown(const Report& report);

/// "3 settings", "1 setting".
[[nodiscard]] std::string counted(std::size_t n, const char* what);
/// A probability of error: "0.023", or "<0.001".
[[nodiscard]] std::string p_value(double p);
/// The same in a sentence: "p = 0.023", or "p < 0.001".
[[nodiscard]] std::string p_text(double p);

}  // namespace glocal
