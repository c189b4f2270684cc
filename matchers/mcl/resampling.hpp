// How many particles a filter needs, and which ones go on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace glocal::mcl {

/// Low variance sampling (Thrun, Burgard and Fox, Probabilistic Robotics, Table 4.4): n indexes, ascending,
/// each as often as n times its weight says, rounded down or up. Weights are not negative and add up to 1;
/// `offset` is random in [0, 1).
[[nodiscard]] std::vector<std::uint32_t> low_variance_draws(const std::vector<double>& weights, std::size_t n,
                                                            double offset);

/// So many samples keep the Kullback-Leibler divergence between the samples' distribution and the one they
/// are drawn from below `error` (Fox, "Adapting the sample size in particle filters through KLD-sampling",
/// IJRR 2003, eq. 14, by the approximation of Wilson and Hilferty). `bins` is how many bins of the pose space
/// the samples fill, `quantile` the upper standard normal quantile of the probability that this holds. 1 for
/// a single bin.
[[nodiscard]] double kld_sample_size(std::size_t bins, double error, double quantile);

/// Mean likelihoods over a short and a long time, which tell when a filter has lost its robot (Augmented MCL:
/// Probabilistic Robotics, Table 8.3).
class RecoveryAverages {
 public:
  /// Rates at which they follow; 0 for either switches recovery off.
  RecoveryAverages(double slow_rate, double fast_rate) : slow_rate_(slow_rate), fast_rate_(fast_rate) {}

  /// Takes in the particles' mean likelihood in one update.
  void add(double likelihood);
  /// Share of the particles that should be new ones, anywhere, in [0, 1].
  [[nodiscard]] double share_of_new() const;
  void reset() { slow_ = fast_ = 0.0; }

 private:
  double slow_rate_, fast_rate_;
  double slow_ = 0.0, fast_ = 0.0;  ///< 0 before the first update.
};

}  // namespace glocal::mcl
