// What the best of many has by chance alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace glocal {

/// Scores of all settings at the same starts: 1 for right, -1 for wrong, 0 for any other end.
using ScoresAtStart = std::vector<std::int8_t>;

/// How far the best of several settings is ahead of the mean of all, and how far it would be if all were
/// equally good: then the outcomes of a start might as well belong to any of the settings.
struct ChanceOfBest {
  std::size_t settings = 0, starts = 0;
  double lead = 0.0;      ///< Best mean score less the mean of all.
  double expected = 0.0;  ///< The same in the mean of resamples with the outcomes of each start exchanged …
  double high = 0.0;      ///< … and what it exceeds in 5 % of them.
  double share = 1.0;     ///< Of resamples with at least the lead there is, which itself counts as one.
  std::size_t resamples = 0;
};

/// Exchanges outcomes with the same random numbers every time; the more there are, the fewer resamples, from
/// 2000 down to 200. None with fewer than two settings, or without starts.
[[nodiscard]] std::optional<ChanceOfBest> chance_of_best(const std::vector<ScoresAtStart>& starts);

}  // namespace glocal
