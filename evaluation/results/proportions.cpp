#include "evaluation/results/proportions.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace glocal {

std::string per_cent(const Proportion& proportion) {
  return fmt::format("{:.1f} ({:.1f} to {:.1f})", 100.0 * proportion.value, 100.0 * proportion.low,
                     100.0 * proportion.high);
}

nlohmann::ordered_json to_json(const Proportion& proportion) {
  return {{"value", proportion.value}, {"low", proportion.low}, {"high", proportion.high}};
}

}  // namespace glocal
