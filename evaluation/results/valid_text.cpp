#include "evaluation/results/valid_text.hpp"

#include <nlohmann/json.hpp>

namespace glocal {

std::string valid_utf8(const std::string& text) {
  using nlohmann::json;
  return json::parse(json(text).dump(-1, ' ', false, json::error_handler_t::replace)).get<std::string>();
}

}  // namespace glocal
