// Poses of one cloud in another, whatever they are turned by: random sample matching with pairs of surfels.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
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
  std::size_t last_round = 0;  ///< In which it was found last.
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
  std::size_t points = 0;      ///< Tested for contact.
};
using PointJudge = std::function<PointEvidence(const RigidMotion& target_from_source)>;

/// The rule for pairs in voxels of a side (m).
[[nodiscard]] PairRule pair_rule(float voxel_size, bool both_sides);

/// Both clouds, and samples of them.
struct SearchScene {
  const PreparedCloud& target;
  const PreparedCloud& source;
  SurfelSample target_sample = {}, source_sample = {};
  PointJudge judge_points = {};
  SearchEffort effort = {};
};

/// What a search has found so far.
struct PoseSearchResult {
  std::vector<FoundPose> poses;  ///< Distinct, falling score; the best few are refined once more.
  SearchEffort effort;
};

/// Finds poses of a cloud in a target. It can be interrupted after any round; how it is divided changes
/// nothing of what it finds.
class PoseSearch {
 public:
  static constexpr std::size_t to_the_end = std::numeric_limits<std::size_t>::max();

  /// Known poses (of the source in the target) are refined and judged beside those to be found; they count as
  /// a round. Both clouds and the target's pairs must outlive the search.
  PoseSearch(const PreparedCloud& target, const PairTable& target_pairs, const PairRule& rule,
             const PreparedCloud& source, const PoseSearchParams& params, Rng rng,
             std::span<const RigidMotion> known = {}, PointJudge judge_points = {});

  /// Goes on until about so many surfels and points more are tested for contact, by at least one round, or to
  /// the end: after a round that finds the best pose once more, if that leaves no doubt, or after the last.
  void advance(std::size_t looks);
  [[nodiscard]] bool is_over() const;
  [[nodiscard]] std::size_t rounds_left() const { return rounds_end_ - round_; }
  [[nodiscard]] PoseSearchResult result() const;

 private:
  void settle(const RigidMotion& motion);
  void search_round();

  const PairTable& pairs_;
  PairRule rule_;
  PoseSearchParams params_;
  Rng rng_;
  SearchScene scene_;
  PairSampler sampler_;
  std::size_t round_ = 0, rounds_end_;  ///< The next one; behind the last.
  std::vector<FoundPose> found_ = {};   ///< Falling score.
};

}  // namespace glocal::surfels
