// 95 % intervals of what two answers to the same questions differ by.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "glocal/rng.hpp"

namespace glocal {

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// Pairs by which of the two, first and second, have a property.
struct PairedCounts {
  std::size_t both = 0;
  std::size_t only_first = 0;
  std::size_t only_second = 0;
  std::size_t neither = 0;
};

/// Share of the second less share of the first, with the interval of Newcombe (1998, method 10, with his
/// correction of phi): Wilson's intervals of both, joined by their correlation. Unlike a bootstrap it has a
/// width where no pair differs. [-1, 1] without pairs.
[[nodiscard]] Interval newcombe_paired(const PairedCounts& counts);

using Statistic = std::function<double(const std::vector<double>&)>;

inline constexpr std::size_t bootstrap_resamples = 10000;

/// Percentile interval of a statistic over resamples of the values (Efron 1979). Of paired differences, so
/// that pairs stay together. `values` must not be empty, and are less than a million.
[[nodiscard]] Interval bootstrap(const std::vector<double>& values, const Statistic& statistic, Rng rng);

}  // namespace glocal
