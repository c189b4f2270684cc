#include "evaluation/results/report_blocks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace glocal {
namespace {

/// Columns a terminal's width of text is broken at.
constexpr std::size_t text_width = 110;

std::string wrapped(const std::string& text, const std::string& first, const std::string& later) {
  std::string result = first;
  std::size_t column = first.size();
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::size_t length = end - begin;
    if (begin > 0 && column + 1 + length > text_width) {
      result += "\n" + later;
      column = later.size();
    } else if (begin > 0) {
      result += " ";
      ++column;
    }
    result.append(text, begin, length);
    column += length;
    begin = end + 1;
  }
  return result + "\n";
}

struct AsText {
  std::string operator()(const Heading& heading) const { return heading.text + "\n"; }
  std::string operator()(const Paragraph& paragraph) const { return wrapped(paragraph.text, "  ", "  "); }
  std::string operator()(const List& list) const {
    std::string text;
    for (const std::string& item : list.items) text += wrapped(item, "  ! ", "    ");
    return text;
  }
  std::string operator()(const Table& table) const {
    std::vector<std::size_t> widths(table.header.size());
    for (std::size_t i = 0; i < widths.size(); ++i) {
      widths[i] = table.header[i].size();
      for (const auto& row : table.rows) widths[i] = std::max(widths[i], row[i].size());
    }
    std::string text = line(table.header, widths);
    for (const auto& row : table.rows) text += line(row, widths);
    return text;
  }

 private:
  static std::string line(const std::vector<std::string>& cells, const std::vector<std::size_t>& widths) {
    std::string text = fmt::format("  {:<{}}", cells[0], widths[0]);
    for (std::size_t i = 1; i < cells.size(); ++i) text += fmt::format("  {:>{}}", cells[i], widths[i]);
    return text.substr(0, text.find_last_not_of(' ') + 1) + "\n";
  }
};

struct AsMarkdown {
  std::string operator()(const Heading& heading) const { return "## " + escaped(heading.text) + "\n"; }
  std::string operator()(const Paragraph& paragraph) const { return escaped(paragraph.text) + "\n"; }
  std::string operator()(const List& list) const {
    std::string text;
    for (const std::string& item : list.items) text += "- " + escaped(item) + "\n";
    return text;
  }
  std::string operator()(const Table& table) const {
    std::string text = line(table.header) + "|---|";
    for (std::size_t i = 1; i < table.header.size(); ++i) text += "---:|";
    text += "\n";
    for (const auto& row : table.rows) text += line(row);
    return text;
  }

 private:
  /// Names may hold what Markdown gives a meaning to, and so does the star of significance.
  static std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
      if (std::string_view("|*_`\\<[").find(c) != std::string_view::npos) result += '\\';
      result += c;
    }
    return result;
  }
  static std::string line(const std::vector<std::string>& cells) {
    std::string text = "|";
    for (const std::string& cell : cells) text += " " + escaped(cell) + " |";
    return text + "\n";
  }
};

template <class Format>
std::string written(const Report& report, const Format& format) {
  std::string text;
  for (const Block& block : report) {
    if (!text.empty()) text += "\n";
    text += std::visit(format, block);
  }
  return text;
}

}  // namespace

std::string as_text(const Report& report) {
  return written(report, AsText{});
}

std::string as_markdown(const Report& report) {
  return written(report, AsMarkdown{});
}

std::string counted(std::size_t n, const char* what) {
  return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
}

std::string p_value(double p) {
  return p < 0.001 ? "<0.001" : fmt::format("{:.3f}", p);
}

std::string p_text(double p) {
  return p < 0.001 ? "p < 0.001" : fmt::format("p = {:.3f}", p);
}

}  // namespace glocal
