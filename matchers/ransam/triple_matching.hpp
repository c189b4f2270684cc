// Triples of two point sets that have the same relation (Section II of the paper, eq. 1 and 2).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "glocal/strategies.hpp"
#include "matchers/common/triangle.hpp"
#include "matchers/common/triple_sampler.hpp"
#include "matchers/ransam/relation_table.hpp"
#include "matchers/ransam/triple_search.hpp"

namespace glocal::ransam {

/// Draws triples of the global and of the local map, and has those tested that meet in a hash table. Whatever
/// their relation is.
///
/// The number of iterations is fixed, so the order of drawing does not matter: all triples of the global map
/// are drawn and hashed first, then those of the local map are drawn and looked up. Pairs are
/// found whichever of the two was drawn first, as when drawing in turns, and both halves split over threads
/// without changing the answer.
class TripleMatching {
 public:
  /// Adds the relations of those triples that the rule admits, as glocal::find_relations() does.
  using FindRelations = void (*)(const Points& points, const TripleBatch& batch, const TriangleRule& rule,
                                 bool neighbours, RelationBatch& relations);
  /// What comes of pairs of triples with the same relation: triple i of the local map's and of the map's.
  /// Called by several threads at a time.
  using TestPairs = std::function<MatchResult(const TripleBatch& local, const TripleBatch& map)>;
  /// Seeds of a step's draws: draw number n of a seed is always the same triple.
  struct Draws {
    std::uint64_t map_seed;
    std::uint64_t local_seed;
  };

  /// `map_points` must outlive it and must not be empty.
  TripleMatching(const Points& map_points, FindRelations find_relations, const TripleSearch& search,
                 int threads);

  /// What was found, as joined() has it. `local` is not empty, and no two of its points are farther apart
  /// than `diameter` (m).
  [[nodiscard]] MatchResult match(const Points& local, double diameter, const Pose3& local_from_robot,
                                  const Draws& draws, const TestPairs& test);

 private:
  void hash_map_triples(std::uint64_t seed, const TriangleRule& rule);
  [[nodiscard]] MatchResult match_local_triples(const Points& local, const TripleSampler& local_sampler,
                                                const TriangleRule& rule, const Draws& draws,
                                                std::size_t chunk, const TestPairs& test) const;
  /// Adds the relations of draws [begin, end) of a seed.
  void add_relations_of_draws(const TripleSampler& sampler, const Points& points, const TriangleRule& rule,
                              bool neighbours, std::uint64_t seed, std::size_t begin, std::size_t end,
                              RelationBatch& relations) const;
  [[nodiscard]] std::size_t chunk_count() const;

  const Points& map_points_;
  FindRelations find_relations_;
  TripleSearch search_;
  std::size_t iterations_;
  int threads_;
  TripleSampler sampler_;  ///< Of the global map.
  RelationTable table_;
  std::vector<RelationBatch> drawn_;  ///< Relations of the map, where several threads find them.
};

}  // namespace glocal::ransam
