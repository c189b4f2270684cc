// Which disturbance, and how much of it: an item of `by`.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "glocal/params.hpp"

namespace glocal::disturbed {

/// What is written down of a kind of disturbance.
struct Kind {
  const char* name;
  const char* amount;            ///< What its amount is.
  const char* unit;              ///< Of its amount.
  double most;                   ///< Amounts are above 0 and at most this.
  std::array<double, 5> levels;  ///< The amounts of level 1 to 5.
  const char* reason;            ///< Why these levels.
  int least = 0;                 ///< If not 0, amounts are whole numbers from this one on.
};

/// A kind by its name, and how much of it.
struct Chosen {
  std::string kind;
  int level = 0;  ///< 1 to 5, or 0 where the amount is given.
  std::optional<double> amount;

  [[nodiscard]] double amount_of(const Kind& of) const {
    return level > 0 ? of.levels[static_cast<std::size_t>(level - 1)] : *amount;
  }
};

/// The fields of one of these kinds.
void describe_chosen(ParamVisitor& v, Chosen& p, const std::vector<Kind>& kinds);

/// Those of `kinds` that are what is said of them alone.
template <class Kinds>
[[nodiscard]] std::vector<Kind> said_of(const Kinds& kinds) {
  return {kinds.begin(), kinds.end()};
}

/// That of this name, which is there.
template <class Kinds>
[[nodiscard]] const auto& kind_named(const std::string& name, const Kinds& kinds) {
  return *std::ranges::find(kinds, name, &Kind::name);
}

}  // namespace glocal::disturbed
