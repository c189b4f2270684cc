// The quality of a hypothesis (eq. 4), given up early where it cannot be good enough (eq. 5).
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "glocal/contact.hpp"
#include "glocal/points.hpp"
#include "glocal/rng.hpp"

namespace glocal {

/// How the extrapolation of eq. 5 goes about it.
struct ExtrapolationRule {
  int batch = 8;               ///< k of eq. 5: points looked at before the bound is computed again.
  double confidence_z = 1.96;  ///< Half width of the interval in standard deviations; 1.96 is 95 %.
};

/// Tests hypotheses of one local map. Points are taken in a random order, as eq. 5 needs; each hypothesis
/// begins at another place of that order, so that not all depend on the same few points.
class QualityTest {
 public:
  /// `local` is not empty; the generator fixes the order.
  QualityTest(const Points& local, std::shared_ptr<const ContactGrid> contact, const ExtrapolationRule& rule,
              Rng& rng);

  struct Outcome {
    std::optional<double> quality;  ///< Omega; none if given up or below the threshold.
    std::size_t checks = 0;         ///< Points looked at.
  };
  /// Omega of a pose if it reaches the threshold. `start` picks where in the order to begin.
  [[nodiscard]] Outcome test(const Transform& map_from_local, double threshold, std::uint32_t start) const;

 private:
  Points shuffled_;  ///< All points, followed by the first batch again, so that a batch never wraps.
  std::size_t size_;
  std::shared_ptr<const ContactGrid> contact_;
  ExtrapolationRule rule_;
};

}  // namespace glocal
