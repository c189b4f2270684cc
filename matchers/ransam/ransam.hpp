#pragma once

#include <memory>
#include <vector>

#include "glocal/catalog.hpp"
#include "glocal/params.hpp"
#include "glocal/strategies.hpp"
#include "matchers/common/beam_evidence.hpp"
#include "matchers/common/triangle.hpp"
#include "matchers/ransam/triple_matching.hpp"
#include "matchers/ransam/triple_search.hpp"

namespace glocal::ransam {

/// Random sample matching (Winkelbach et al.; Section II of the paper): triples of points drawn from the
/// local and from the global map, joined over a hash table by their relation, give hypotheses; all that reach
/// Omega_max are kept.
///
/// Beyond the paper, `blocked_weight` times the share of beams that would have passed through walls may be
/// taken off the score of what reached Omega_max; what falls below it is dropped. Contact alone cannot tell
/// two places apart that differ by a wall in one of them.
class Ransam final : public Matcher {
 public:
  struct Params {
    TripleSearch triples = {};
    BeamRule beams = {};
  };

  /// Throws ConfigError where the map is too large for a contact grid.
  Ransam(const Params& params, const StageSetup& setup);

  [[nodiscard]] MatchResult match(const MatchRequest& request, Rng& rng) override;
  void reset() override { beams_.clear(); }

 private:
  /// Tests the hypotheses of pairs of triples.
  [[nodiscard]] MatchResult test_hypotheses(const MatchRequest& request, const QualityTest& quality,
                                            const TripleBatch& local_triples,
                                            const TripleBatch& map_triples) const;
  void ask_beams(std::vector<Hypothesis>& hypotheses, double omega_max) const;

  Params params_;
  StageSetup setup_;
  std::shared_ptr<const ContactIndex> contact_;
  TripleMatching matching_;
  BeamEvidence beams_;
  std::shared_ptr<const ClearanceGrid> clearance_;  ///< Null where beams are not asked.
};
void describe(ParamVisitor& v, Ransam::Params& p);

}  // namespace glocal::ransam
