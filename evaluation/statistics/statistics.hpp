// The few statistics a summary needs.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace glocal {

/// The p-quantile (p in [0, 1]) by linear interpolation between order statistics (R's type 7); 0 for no
/// values.
[[nodiscard]] double quantile(std::vector<double> values, double p);
/// The median; none of no values.
[[nodiscard]] std::optional<double> median_if_any(std::vector<double> values);

/// 0 for no values.
[[nodiscard]] double mean(const std::vector<double>& values);

struct Proportion {
  double value = 0.0;
  double low = 0.0;
  double high = 1.0;
};

/// A share with its 95 % interval after Wilson (1927); 0 of 0 has value 0 and the interval [0, 1].
[[nodiscard]] Proportion wilson(std::size_t successes, std::size_t trials);

/// Trials that have something in common, so that they tend to end alike.
struct TrialCluster {
  std::size_t successes = 0;
  std::size_t trials = 0;
};
/// The share of all trials, with Wilson's interval for as many independent trials as tell as much as these
/// (Korn and Graubard 1998: by the variance between clusters, and by Student's t, as few clusters tell that
/// variance badly). With one trial in each cluster it is that of wilson(). Where all end the same, or there
/// is one cluster, each counts as one trial.
[[nodiscard]] Proportion wilson_of_clusters(const std::vector<TrialCluster>& clusters);

}  // namespace glocal
