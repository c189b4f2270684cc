// How far settings are ahead of one another, and how much of it is chance.
#pragma once

#include <cstddef>
#include <vector>

namespace glocal {

/// Of each setting the sum of its scores at one place, over all seeds: 1 for right, -1 for wrong, 0 for any
/// other end of a trial. Every setting has the same trials there.
using ScoresAtPlace = std::vector<int>;

/// One setting against another one.
struct Lead {
  long score = 0;  ///< Sum of its scores less those of the other; negative if it is behind.
  std::size_t places_better = 0, places_worse = 0;
  double p = 1.0;
};

/// The lead of one over another, tested by itself: by the signs of places (sign_flip_test()). That the best
/// of many is better than the second best may be tested so, too (Gutmann and Maymin 1987).
[[nodiscard]] Lead lead_of(std::size_t setting, std::size_t other, const std::vector<ScoresAtPlace>& places);

/// The leads of all settings over one of them. As many are compared, p is that of the largest: how often the
/// signs of places, the same for all settings, give any of them a sum so large for its spread (Westfall and
/// Young 1993). Settings that differ from the baseline at too few places to be found by themselves are left
/// out of it. The random signs are the same every time; the more there are, the fewer times, from 5000 down
/// to 500.
[[nodiscard]] std::vector<Lead> leads_over(std::size_t baseline, const std::vector<ScoresAtPlace>& places);

}  // namespace glocal
