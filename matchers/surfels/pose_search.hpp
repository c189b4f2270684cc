// Poses of one cloud in another, whatever they are turned by: random sample matching with pairs of surfels.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "glocal/params.hpp"
#include "glocal/prior.hpp"
#include "glocal/rng.hpp"
#include "matchers/surfels/prepared_cloud.hpp"
#include "matchers/surfels/surfel_pairs.hpp"

namespace glocal::surfels {

/// What is searched, and how long. Each round draws pairs, looks up what they may lie on, and narrows the
/// poses down. Rounds are short: most searches are beyond doubt after a few.
struct PoseSearchParams {
  std::size_t rounds = 16;      ///< At most.
  std::size_t draws = 600;      ///< Pairs of a round.
  std::size_t partners = 8;     ///< Pairs of the target tried for each.
  std::size_t looked_at = 400;  ///< Poses of a round that are refined a little and judged by both sides.
  std::size_t refined = 12;     ///< Distinct poses of a round that are refined and judged by all surfels.
  double seen_through_weight = 5.0;
  double free_space_weight = 0.0;
  bool upright = false;  ///< Both z axes point up: poses turn about z alone.
  PoseGate gate = {};    ///< Poses that it does not allow are not found.
};

/// A pose of the source in the target.
struct FoundPose {
  RigidMotion target_from_source;
  /// Share of surfels in contact, by weight; of both clouds where both have a view. Where the search is told
  /// the evidence of points, the mean of their contact and this.
  double contact = 0.0;
  /// Share that the other's sensor looked through. Of a target without a view, which is taken for a map:
  /// share of what the source's sensor looked through among what it looked at.
  double seen_through = 0.0;
  double in_free_space = 0.0;  ///< Share of points, where the search is told their evidence.
  double score = 0.0;          ///< Contact less the weighted shares.
  std::size_t rounds = 1;      ///< In how many rounds it was found.
};

/// What a search has cost.
struct SearchEffort {
  std::size_t proposals = 0;      ///< Poses that pairs proposed.
  std::size_t points_tested = 0;  ///< Single surfels tested for contact.
};

/// Shares of the source's points, where the target is known more finely than by surfels; in [0, 1].
struct PointEvidence {
  double contact = 0.0;
  double in_free_space = 0.0;  ///< Where the target is known to be free, away from anything.
};
using PointJudge = std::function<PointEvidence(const RigidMotion& target_from_source)>;

/// The rule for pairs in voxels of a side (m).
[[nodiscard]] PairRule pair_rule(float voxel_size, bool both_sides);

/// Finds poses of clouds in a target that is made ready once.
class PoseSearch {
 public:
  /// Target and pairs must outlive it.
  PoseSearch(const PreparedCloud& target, const PairTable& target_pairs, const PairRule& rule,
             const PoseSearchParams& params)
      : target_(target), pairs_(target_pairs), rule_(rule), params_(params) {}

  /// Distinct poses, falling score. Ends after a round that finds the best pose once more, if that leaves no
  /// doubt. Known poses (of the source in the target) are refined and judged beside those found; they count
  /// as a round. `effort` is added to.
  [[nodiscard]] std::vector<FoundPose> find(const PreparedCloud& source, Rng rng,
                                            std::span<const RigidMotion> known = {},
                                            const PointJudge& judge_points = {},
                                            SearchEffort* effort = nullptr) const;

 private:
  const PreparedCloud& target_;
  const PairTable& pairs_;
  PairRule rule_;
  PoseSearchParams params_;
};

}  // namespace glocal::surfels
