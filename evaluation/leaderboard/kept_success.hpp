// What disturbances leave of a method's success.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "config/suites.hpp"
#include "evaluation/leaderboard/board_entry.hpp"

namespace glocal {

inline constexpr int worst_level = 5;

/// "intel_people-3" beside "intel", as add_disturbed_cases() names it: a place, a kind and a level.
struct DisturbedCase {
  std::string name, place, kind;
  int level = 0;
};

struct DisturbedKind {
  std::string name;
  std::vector<DisturbedCase> cases;
};
/// Of the suite's cases those that its key `disturbances` has made, by kinds.
[[nodiscard]] std::vector<DisturbedKind> disturbed_kinds(const Suite& suite);

/// Those of this level.
[[nodiscard]] std::vector<DisturbedCase> of_level(const std::vector<DisturbedCase>& cases, int level);

struct KeptSuccess {
  /// The share of right starts over that share of the undisturbed place: the mean over cases. None where the
  /// method is right nowhere without disturbances.
  std::optional<double> share = {};
  BoardCounts counts = {};
};
[[nodiscard]] KeptSuccess kept_success(const BoardEntry& entry, const std::vector<DisturbedCase>& cases);

}  // namespace glocal
