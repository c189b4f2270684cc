// What packed() has packed.
#pragma once

#include <zlib.h>

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>

#include "report/page.hpp"

namespace glocal::test {

inline std::string from_base64(std::string_view text) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0;
  int held = 0;
  for (const char c : text.substr(0, text.find('='))) {
    const std::size_t digit = digits.find(c);
    if (digit == std::string_view::npos) throw std::invalid_argument("is no base64");
    bits = bits << 6U | static_cast<unsigned>(digit);
    held += 6;
    if (held < 8) continue;
    held -= 8;
    bytes += static_cast<char>(bits >> static_cast<unsigned>(held) & 255U);
  }
  return bytes;
}

inline nlohmann::ordered_json unpacked(std::string_view text) {
  const std::string bytes = from_base64(text);
  for (std::size_t room = 1'000'000; room < 2'000'000'000; room *= 4) {
    std::string result(room, '\0');
    uLongf size = room;
    const int state = uncompress(reinterpret_cast<Bytef*>(result.data()), &size,
                                 reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
    if (state == Z_OK) return nlohmann::ordered_json::parse(result.substr(0, size));
    if (state != Z_BUF_ERROR) throw std::invalid_argument("is not compressed");
  }
  throw std::invalid_argument("is too long");
}

/// The head with the chunks of all trials in the places of their numbers.
inline nlohmann::ordered_json whole(const PageData& page) {
  nlohmann::ordered_json json = page.head;
  for (auto& run : json["runs"]) {
    for (auto& trial : run["trials"]) {
      if (!trial.contains("chunk")) continue;
      trial.update(unpacked(page.chunks.at(trial["chunk"])));
      trial.erase("chunk");
    }
  }
  return json;
}

/// The content of a page's element.
inline std::string_view element_of(std::string_view page, const std::string& id) {
  const std::string begin = "<script type=\"text/plain\" id=\"" + id + "\">";
  const std::size_t at = page.find(begin);
  if (at == std::string_view::npos) return {};
  const std::size_t from = at + begin.size();
  return page.substr(from, page.find("</script>", from) - from);
}

/// What page_with() has put into a page.
inline PageData data_in(std::string_view page) {
  PageData data{unpacked(element_of(page, "glocal-data"))};
  for (;;) {
    const std::string_view chunk = element_of(page, "glocal-chunk-" + std::to_string(data.chunks.size()));
    if (chunk.empty()) return data;
    data.chunks.emplace_back(chunk);
  }
}

}  // namespace glocal::test
