// 95 % intervals of what two methods differ by, from trials at the same places.
#pragma once

#include <cstddef>
#include <vector>

#include "glocal/rng.hpp"

namespace glocal {

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// How two methods ended at one place: of so many trials, which tend to end alike, only the first, and only
/// the second, had a property. Places are a sample of those of their stratum.
struct PlaceOutcomes {
  std::size_t stratum = 0;
  std::size_t trials = 0;
  std::size_t only_first = 0;
  std::size_t only_second = 0;
};

/// Share of the second less share of the first: that of Bonett and Price (2012), a normal interval with one
/// pair more that differs in either way, for as many independent pairs as tell as much as these (by the
/// variance between places within strata; Korn and Graubard 1998). It has a width where no pair differs;
/// each place then counts as one pair. [-1, 1] without trials.
[[nodiscard]] Interval interval_of_shares(const std::vector<PlaceOutcomes>& places);

/// What two methods differ by at one place, summed over its trials, at least one.
struct PlaceSum {
  std::size_t stratum = 0;
  std::size_t trials = 0;
  double sum = 0.0;
};

/// The mean difference of a trial: the studentized bootstrap (Hall 1988) over places within strata, never
/// shorter than Student's interval. The more places, the fewer resamples, from 4000 down to 400. `places` has
/// at least two, and less than a million.
[[nodiscard]] Interval interval_of_mean(const std::vector<PlaceSum>& places, Rng rng);

/// How many such places it takes for a test at the 5 % level to find a difference of this size with a chance
/// of 80 %, where so many places gave this 95 % interval.
[[nodiscard]] double places_to_find(double difference, std::size_t places, const Interval& interval);

}  // namespace glocal
