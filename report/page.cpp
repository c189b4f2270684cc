#include "report/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "report/page_text.hpp"

namespace glocal {
namespace {

using Json = nlohmann::ordered_json;
using Replacement = std::pair<std::string_view, std::string_view>;

template <std::size_t N>
std::string replaced(std::string_view text, const std::array<Replacement, N>& replacements) {
  std::string result;
  result.reserve(text.size() + text.size() / 16);
  while (!text.empty()) {
    std::size_t taken = 1;
    std::string_view put = text.substr(0, 1);
    for (const auto& [from, to] : replacements) {
      if (!text.starts_with(from)) continue;
      taken = from.size();
      put = to;
    }
    result += put;
    text.remove_prefix(taken);
  }
  return result;
}

/// As the content of a script element, which "</script" and "<!--" would end or change. JSON has '<' in
/// strings only. U+2028 and U+2029 end lines for readers of JavaScript.
std::string in_script(const std::string& json) {
  return replaced(json, std::array{Replacement{"<", "\\u003c"}, Replacement{"\xe2\x80\xa8", "\\u2028"},
                                   Replacement{"\xe2\x80\xa9", "\\u2029"}});
}

std::string in_html(const std::string& text) {
  return replaced(text,
                  std::array{Replacement{"&", "&amp;"}, Replacement{"<", "&lt;"}, Replacement{">", "&gt;"}});
}

/// What is before and after the mark.
std::pair<std::string_view, std::string_view> split(std::string_view page, std::string_view mark) {
  const std::size_t at = page.find(mark);
  if (at == std::string_view::npos || page.find(mark, at + 1) != std::string_view::npos)
    throw std::logic_error(fmt::format("the page must have {} once", mark));
  return {page.substr(0, at), page.substr(at + mark.size())};
}

}  // namespace

std::string json_text(const Json& data) {
  return data.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string_view script_for(const Json& data) {
  const Json& maps = data.at("maps");
  const bool is_in_space =
      std::any_of(maps.begin(), maps.end(), [](const Json& map) { return map.contains("z"); });
  return is_in_space ? space_text : std::string_view{};
}

std::string page_with(std::string_view page, const std::string& title, const Json& data,
                      std::string_view script) {
  const auto [before_title, after_title] = split(page, "<!--glocal:title-->");
  const auto [before_data, after_data] = split(after_title, "<!--glocal:data-->");
  const std::string text_title = Json::parse(json_text(title)).get<std::string>();  // in UTF-8
  std::string result(before_title);
  result += in_html(text_title);
  result += before_data;
  result += R"(<script type="application/json" id="glocal-data">)";
  result += in_script(json_text(data));
  result += "</script>";
  if (!script.empty()) result.append("<script>").append(script).append("</script>");
  result += after_data;
  return result;
}

}  // namespace glocal
