#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "glocal/catalog.hpp"
#include "glocal/params.hpp"
#include "glocal/strategies.hpp"
#include "matchers/common/beam_evidence.hpp"
#include "matchers/common/quality.hpp"
#include "matchers/common/triangle.hpp"
#include "matchers/common/triple_sampler.hpp"
#include "matchers/ransam/relation_table.hpp"

namespace glocal {

/// Random sample matching (Winkelbach et al.; Section II of the paper): triples of points drawn from the
/// local and from the global map, joined over a hash table by their relation, give hypotheses; all that reach
/// Omega_max are kept.
///
/// The number of iterations is fixed, so the order of drawing does not matter: all triples of the global map
/// are drawn and hashed first, then those of the local map are drawn and looked up. Pairs are
/// found whichever of the two was drawn first, as when drawing in turns, and both halves split over threads
/// without changing the answer.
///
/// Beyond the paper, `blocked_weight` times the share of beams that would have passed through walls may be
/// taken off the score of what reached Omega_max; what falls below it is dropped. Contact alone cannot tell
/// two places apart that differ by a wall in one of them.
class Ransam final : public Matcher {
 public:
  struct Params {
    int iterations = 200000;
    std::optional<double> contact_epsilon = {};
    double relation_cell = 0.10;
    double min_side = 0.3;
    double min_height = 0.1;
    double local_radius = 0.0;
    int extrapolation_batch = 8;
    double extrapolation_z = 1.96;
    std::string extrapolation = "interval";
    double wald_false_rejects = 0.025;
    double wald_background = 0.3;
    ContactChoice contact = "bitset";
    bool neighbour_cells = false;
    int max_hypotheses = 10000;
    int table_bits = 0;
    BeamRule beams = {};
  };

  /// Throws ConfigError where the map is too large for a contact grid.
  Ransam(const Params& params, const StageSetup& setup);

  [[nodiscard]] MatchResult match(const LocalMap& local, const Observation& latest, double omega_max,
                                  Rng& rng) override;
  void reset() override { beams_.clear(); }

 private:
  /// Seeds of a step's draws: draw number n of a seed is always the same triple.
  struct Draws {
    std::uint64_t map_seed;
    std::uint64_t local_seed;
  };
  [[nodiscard]] std::size_t iterations() const { return static_cast<std::size_t>(params_.iterations); }
  [[nodiscard]] std::size_t chunk_count() const;
  void hash_map_triples(std::uint64_t seed, const TriangleRule& rule);
  [[nodiscard]] MatchResult match_local_triples(const LocalMap& local, const TripleSampler& local_sampler,
                                                const QualityTest& quality, const TriangleRule& rule,
                                                const Draws& draws, std::size_t chunk) const;
  /// Tests the hypotheses of pairs of triples, given by their numbers.
  void test_hypotheses(const LocalMap& local, const TripleSampler& local_sampler, const QualityTest& quality,
                       const Draws& draws, TripleBatch& local_triples, TripleBatch& map_triples,
                       MatchResult& found) const;
  void ask_beams(std::vector<Hypothesis>& hypotheses, double omega_max) const;

  Params params_;
  StageSetup setup_;
  std::shared_ptr<const ContactIndex> contact_;
  TripleSampler sampler_;  ///< Of the global map.
  RelationTable table_;
  std::vector<RelationBatch> drawn_;  ///< Relations of the map, where several threads find them.
  BeamEvidence beams_;
  std::shared_ptr<const ClearanceGrid> clearance_;  ///< Null where beams are not asked.
};
void describe(ParamVisitor& v, Ransam::Params& p);

}  // namespace glocal
