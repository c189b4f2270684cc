// Places of values by size.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace glocal {

/// The distinct sizes of tied groups enter the variance only; ranks are doubled to keep means of ties whole.
struct Ranks {
  std::vector<std::size_t> doubled;  ///< In the order of the values.
  double tie_term = 0.0;             ///< Sum of t^3 - t over groups of t equal values.
};
/// Ranks from 1 up; equal values share the mean of theirs.
[[nodiscard]] Ranks ranks_of(const std::vector<double>& values);

/// Spearman's rank correlation (1904) of values that belong together, ties sharing their ranks; none where
/// one of the two is the same everywhere.
[[nodiscard]] std::optional<double> spearman(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace glocal
