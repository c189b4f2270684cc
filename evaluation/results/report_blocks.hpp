// Reports as text for a terminal, and as Markdown.
#pragma once

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

}  // namespace glocal
