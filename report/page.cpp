#include "report/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "evaluation/results/json_text.hpp"
#include "evaluation/results/provenance.hpp"
#include "report/packed.hpp"
#include "report/page_text.hpp"

namespace glocal {
namespace {

using Json = nlohmann::ordered_json;

/// So much of a file beside the page is loaded at once.
constexpr std::size_t beside_file_bytes = 200'000;
constexpr std::size_t hash_digits = 16;

std::string in_html(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string script_of_data(const std::string& id, const std::string& packed_data) {
  return fmt::format(R"(<script type="text/plain" id="{}">{}</script>)", id, packed_data);
}

std::string hash_of(const std::vector<std::string>& chunks) {
  std::string all;
  for (const std::string& chunk : chunks) all += sha256_of_text(chunk);
  return sha256_of_text(all).substr(0, hash_digits);
}

/// What is before and after the mark.
std::pair<std::string_view, std::string_view> split(std::string_view page, std::string_view mark) {
  const std::size_t at = page.find(mark);
  if (at == std::string_view::npos || page.find(mark, at + 1) != std::string_view::npos)
    throw std::logic_error(fmt::format("the page must have {} once", mark));
  return {page.substr(0, at), page.substr(at + mark.size())};
}

}  // namespace

std::vector<PageFile> put_beside(PageData& data, const std::string& folder) {
  const std::string hash = hash_of(data.chunks);
  std::vector<PageFile> files;
  Json first = Json::array();  // of each file
  for (std::size_t i = 0; i < data.chunks.size(); ++i) {
    if (files.empty() || files.back().content.size() > beside_file_bytes) {
      files.push_back({fmt::format("{}_{}.js", hash, files.size()), "glocalChunks({"});
      first.push_back(i);
    }
    files.back().content += fmt::format("\"{}\":\"{}\",\n", i, data.chunks[i]);
  }
  for (PageFile& file : files) file.content += "});\n";
  data.head["beside"] = {{"folder", folder}, {"hash", hash}, {"first", std::move(first)}};
  data.chunks.clear();
  return files;
}

bool is_beside_file(std::string_view name) {
  constexpr std::string_view digits = "0123456789";
  if (!name.ends_with(".js") || name.size() <= hash_digits || name[hash_digits] != '_') return false;
  name.remove_suffix(3);
  const bool has_hash =
      name.substr(0, hash_digits).find_first_not_of("0123456789abcdef") == std::string_view::npos;
  const std::string_view number = name.substr(hash_digits + 1);
  return has_hash && !number.empty() && number.find_first_not_of(digits) == std::string_view::npos;
}

std::string_view script_for(const Json& head) {
  const auto maps = head.find("maps");
  const bool is_in_space = maps != head.end() && std::any_of(maps->begin(), maps->end(), [](const Json& map) {
                             return map.contains("z");
                           });
  return is_in_space ? space_text : std::string_view{};
}

std::string page_with(std::string_view page, const std::string& title, const PageData& data) {
  const auto [before_leave, after_leave] = split(page, "<!--glocal:leave-->");
  const auto [before_title, after_title] = split(after_leave, "<!--glocal:title-->");
  const auto [before_data, after_data] = split(after_title, "<!--glocal:data-->");
  std::string result(before_leave);
  if (data.head.contains("beside")) result += " 'self' file:";
  result += before_title;
  result += in_html(valid_utf8(title));
  result += before_data;
  result += script_of_data("glocal-data", packed(data.head));
  for (std::size_t i = 0; i < data.chunks.size(); ++i)
    result += script_of_data(fmt::format("glocal-chunk-{}", i), data.chunks[i]);
  if (const std::string_view script = script_for(data.head); !script.empty())
    result.append("<script>").append(script).append("</script>");
  result += after_data;
  return result;
}

}  // namespace glocal
