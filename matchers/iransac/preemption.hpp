// Which hypotheses deserve another look: breadth-first, the worse half dropped again and again.
#pragma once

#include <cstddef>
#include <vector>

#include "glocal/contact.hpp"
#include "glocal/points.hpp"
#include "glocal/pose2.hpp"

namespace glocal::iransac {

/// A pose, and the observations it has been scored by: points of the local map in contact, of those looked
/// at.
struct ScoredPose {
  Pose2 map_from_local;
  std::size_t in_contact = 0;
  std::size_t looked_at = 0;

  [[nodiscard]] double score() const {
    return looked_at == 0 ? 0.0 : static_cast<double>(in_contact) / static_cast<double>(looked_at);
  }
};

struct PreemptionRule {
  std::size_t block = 16;   ///< B: observations between two halvings.
  std::size_t fewest = 50;  ///< Preemption ends with so many left.
};

/// How many of M hypotheses are left after i observations: floor(M 2^(-floor(i / B))) (Nister 2003, eq. 4).
[[nodiscard]] std::size_t left_after(std::size_t hypotheses, std::size_t observations, std::size_t block);

/// Scores all hypotheses by one block of observations after the other and keeps the best left_after() of
/// each, until the fewest are left or observations end. Fresh ones (never looked at) see `all` points, those
/// carried on from earlier steps only `latest`, the ones that are new: what they have seen before stays
/// counted. Those left are sorted by falling score; among equals, the first stays first. The same for any
/// number of threads. Returns how many points were looked at.
std::size_t preempt(std::vector<ScoredPose>& hypotheses, const ContactIndex& contact, const Points& all,
                    const Points& latest, const PreemptionRule& rule, int threads);

}  // namespace glocal::iransac
