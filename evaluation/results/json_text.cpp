#include "evaluation/results/json_text.hpp"

#include <exception>
#include <stdexcept>

namespace glocal {
namespace {

constexpr int max_depth = 64;

/// Brackets in texts are no depth.
bool is_too_deep(const std::string& text) {
  int depth = 0;
  bool in_text = false;
  for (std::size_t i = 0; i < text.size() && depth <= max_depth; ++i) {
    const char c = text[i];
    if (c == '"') in_text = !in_text;
    if (in_text && c == '\\') ++i;
    if (in_text) continue;
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
  }
  return depth > max_depth;
}

std::size_t whole(const nlohmann::ordered_json& json, const std::string& name) {
  if (!json.is_number_unsigned()) throw std::invalid_argument("'" + name + "' is no whole number from 0 on");
  return json.get<std::size_t>();
}

}  // namespace

nlohmann::ordered_json parse_json(const std::string& text) {
  if (is_too_deep(text)) {
    throw std::invalid_argument("nested deeper than " + std::to_string(max_depth) + " levels");
  }
  return nlohmann::ordered_json::parse(text);
}

std::size_t whole_number(const nlohmann::ordered_json& object, const char* key) {
  return whole(object.at(key), key);
}

std::size_t whole_number(const nlohmann::ordered_json& array, std::size_t index) {
  return whole(array.at(index), std::to_string(index));
}

std::string json_text(const nlohmann::ordered_json& json, int indent) {
  return json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::string valid_utf8(const std::string& text) {
  return nlohmann::ordered_json::parse(json_text(text)).get<std::string>();
}

std::string reason(const std::exception& error) {
  const std::string text = error.what();
  const std::size_t name_end = text.find("] ");
  return text.starts_with("[json.exception.") && name_end != std::string::npos ? text.substr(name_end + 2)
                                                                               : text;
}

}  // namespace glocal
