// The quality of a hypothesis (eq. 4), given up early where it cannot be good enough (eq. 5).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "glocal/contact.hpp"
#include "glocal/points.hpp"
#include "glocal/rng.hpp"
#include "matchers/surfels/rigid_motion.hpp"

namespace glocal {

/// When a hypothesis is given up, after a part of its points.
struct ExtrapolationRule {
  enum class Kind {
    interval,  ///< eq. 5: the upper end of a confidence interval is below the threshold.
    wald       ///< Wald's sequential test of "as good as the threshold" against "background".
  };
  Kind kind = Kind::interval;
  int batch = 8;               ///< k of eq. 5: points looked at before the bound is computed again.
  double confidence_z = 1.96;  ///< interval: half width in standard deviations; 1.96 is 95 %.
  /// wald: how often a hypothesis just as good as the threshold may be given up at all, however often it is
  /// looked at.
  double false_rejects = 0.025;
  double background = 0.3;  ///< wald: share of points a wrong pose has in contact by chance.
};

/// How many of the first `looked_at` of `points` must be in contact for a hypothesis to be pursued. Besides
/// the rule, one that misses the threshold even if all the others are in contact is given up.
[[nodiscard]] std::size_t least_in_contact(const ExtrapolationRule& rule, double threshold,
                                           std::size_t points, std::size_t looked_at);

/// Tests hypotheses of one local map. Points are taken in a random order, as eq. 5 needs; each hypothesis
/// begins at another place of that order, so that not all depend on the same few points. Timed by
/// bench_extrapolation.
class QualityTest {
 public:
  /// `local` is not empty; the generator fixes the order.
  QualityTest(const Points& local, std::shared_ptr<const ContactIndex> contact, const ExtrapolationRule& rule,
              double threshold, Rng& rng);

  /// A pose that reaches the threshold.
  struct Passed {
    std::size_t index;  ///< Among those tested.
    double quality;     ///< Omega
  };
  struct Outcome {
    std::vector<Passed> passed;     ///< In the order of the poses.
    std::size_t points_tested = 0;  ///< Points looked at.
  };
  /// Tests the first `size` poses of a batch. `starts` (any numbers) pick where in the order each begins.
  [[nodiscard]] Outcome test(const MotionBatch& map_from_local, std::size_t size,
                             const ContactIndex::BatchColumn& starts) const;

  /// One pose in space.
  struct Judged {
    std::optional<double> quality;  ///< Omega, of a pose that reaches the threshold.
    std::size_t points_tested = 0;
  };
  /// Tests one pose in space. `memory` is overwritten: who tests many poses gives the same each time.
  [[nodiscard]] Judged test(const RigidMotion& map_from_local, std::uint32_t start, Points& memory) const;

 private:
  [[nodiscard]] std::size_t place_in_order(std::uint32_t start) const {
    return static_cast<std::size_t>(std::uint64_t{start} * size_ >> 32U);
  }

  Points shuffled_;  ///< All points twice, so that a test never wraps.
  std::size_t size_;
  std::size_t batch_;
  std::vector<std::uint32_t> least_;  ///< least_in_contact() after each batch.
  std::shared_ptr<const ContactIndex> contact_;
};

}  // namespace glocal
