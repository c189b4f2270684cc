// What the best of many has by chance alone.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace glocal {

/// Of each setting the sum of its scores at one place of a drive, with all seeds: 1 for right, -1 for wrong,
/// 0 for any other end of a trial. Every setting has the same trials there.
using ScoresAtPlace = std::vector<int>;

/// How far the best of several settings is ahead of the mean of all, and how far it would be if all were
/// equally good: then the outcomes of a place might as well belong to any of the settings. Those of all seeds
/// stay together, as they tend to be alike.
struct ChanceOfBest {
  std::size_t settings = 0, places = 0;
  double lead = 0.0;      ///< Best mean score of a trial less the mean of all settings.
  double expected = 0.0;  ///< The same in the mean of resamples with the outcomes of each place exchanged …
  double high = 0.0;      ///< … and what it exceeds in 5 % of them.
  double share = 1.0;     ///< Of resamples with at least the lead there is, which itself counts as one.
  std::size_t resamples = 0;
};

/// Exchanges outcomes with the same random numbers every time; the more there are, the fewer resamples, from
/// 2000 down to 200. Each setting has so many `trials` in all. None with fewer than two settings, or without
/// places.
[[nodiscard]] std::optional<ChanceOfBest> chance_of_best(const std::vector<ScoresAtPlace>& places,
                                                         std::size_t trials);

}  // namespace glocal
