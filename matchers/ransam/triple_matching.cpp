#include "matchers/ransam/triple_matching.hpp"

#include <algorithm>
#include <bit>

#include "glocal/parallel.hpp"
#include "matchers/common/merge.hpp"

namespace glocal::ransam {
namespace {

/// Draws handled together by one thread. Fixed, so that the answer does not depend on the number of threads.
constexpr std::size_t draws_per_chunk = RelationBatch::probes * TripleBatch::capacity;
/// Chunks of the map's relations kept in memory: 4.5 MB.
constexpr std::size_t chunks_at_a_time = 256;

unsigned table_bits(const TripleSearch& search) {
  // Two slots a draw. Half of the draws of a map have no relation worth keeping, so about one entry in eight
  // is lost to another relation in its slot; a larger table costs more time than it gains.
  return static_cast<unsigned>(std::bit_width(static_cast<unsigned>(search.iterations) * 2U - 1U));
}

}  // namespace

TripleMatching::TripleMatching(const Points& map_points, FindRelations find_relations,
                               const TripleSearch& search, int threads)
    : map_points_(map_points),
      find_relations_(find_relations),
      search_(search),
      iterations_(static_cast<std::size_t>(search.iterations)),
      threads_(threads),
      sampler_(map_points, search.local_radius),
      table_(table_bits(search)) {}

MatchResult TripleMatching::match(const Points& local, double diameter, const Pose3& local_from_robot,
                                  const Draws& draws, const TestPairs& test) {
  // A triangle of the map that is larger than the whole local map has no partner there.
  const TriangleRule rule{
      .cell = search_.relation_cell,
      .min_side = search_.min_side,
      .min_height = search_.min_height,
      .max_side = std::min(diameter + search_.relation_cell, largest_side(search_.relation_cell))};
  const TripleSampler local_sampler(local, search_.local_radius);
  hash_map_triples(draws.map_seed, rule);
  std::vector<MatchResult> chunks(chunk_count());
  parallel_for(threads_, chunks.size(), [&](std::size_t i) {
    chunks[i] = match_local_triples(local, local_sampler, rule, draws, i, test);
  });
  return joined(chunks, local_from_robot, static_cast<std::size_t>(search_.max_hypotheses));
}

std::size_t TripleMatching::chunk_count() const {
  return (iterations_ + draws_per_chunk - 1) / draws_per_chunk;
}

void TripleMatching::add_relations_of_draws(const TripleSampler& sampler, const Points& points,
                                            const TriangleRule& rule, bool neighbours, std::uint64_t seed,
                                            std::size_t begin, std::size_t end,
                                            RelationBatch& relations) const {
  TripleBatch triples;
  while (begin < end) {
    triples.clear();
    while (begin < end && !triples.full()) triples.add_number(static_cast<std::uint32_t>(begin++));
    sampler.draw(seed, triples);
    find_relations_(points, triples, rule, neighbours, relations);
  }
}

void TripleMatching::hash_map_triples(std::uint64_t seed, const TriangleRule& rule) {
  const auto draw_chunk = [&](std::size_t chunk, RelationBatch& drawn) {
    drawn.size = 0;
    const std::size_t begin = chunk * draws_per_chunk;
    const std::size_t end = std::min(begin + draws_per_chunk, iterations_);
    add_relations_of_draws(sampler_, map_points_, rule, false, seed, begin, end, drawn);
  };
  table_.begin_fill(iterations_);
  if (threads_ <= 1) {
    RelationBatch drawn;
    for (std::size_t chunk = 0; chunk < chunk_count(); ++chunk) {
      draw_chunk(chunk, drawn);
      table_.fill(drawn);
    }
    return;
  }
  // Threads that wrote to the whole table would take its lines from each other all the time. So relations are
  // found first, some chunks at a time, and then each thread fills a share of the table of its own.
  const auto shares = static_cast<std::size_t>(threads_);
  for (std::size_t begin = 0; begin < chunk_count(); begin += chunks_at_a_time) {
    drawn_.resize(std::min(chunks_at_a_time, chunk_count() - begin));
    parallel_for(threads_, drawn_.size(), [&](std::size_t i) { draw_chunk(begin + i, drawn_[i]); });
    parallel_for(threads_, shares, [&](std::size_t share) {
      for (const RelationBatch& drawn : drawn_) table_.fill(drawn, share, shares);
    });
  }
}

MatchResult TripleMatching::match_local_triples(const Points& local, const TripleSampler& local_sampler,
                                                const TriangleRule& rule, const Draws& draws,
                                                std::size_t chunk, const TestPairs& test) const {
  MatchResult found;
  RelationBatch relations;
  PartnerBatch partners;
  TripleBatch local_triples;
  TripleBatch map_triples;
  const auto test_collisions = [&] {
    // Drawing again is cheaper than having kept the triples of all draws.
    local_sampler.draw(draws.local_seed, local_triples);
    sampler_.draw(draws.map_seed, map_triples);
    append(test(local_triples, map_triples), found);
    local_triples.clear();
    map_triples.clear();
  };
  const std::size_t end = std::min((chunk + 1) * draws_per_chunk, iterations_);
  for (std::size_t begin = chunk * draws_per_chunk; begin < end; begin += TripleBatch::capacity) {
    relations.size = 0;
    add_relations_of_draws(local_sampler, local, rule, search_.neighbour_cells, draws.local_seed, begin,
                           std::min(begin + TripleBatch::capacity, end), relations);
    table_.find(relations, partners);  // eq. 2
    for (std::size_t i = 0; i < partners.size; ++i) {
      local_triples.add_number(partners.numbers[i]);
      map_triples.add_number(partners.partners[i]);
      if (local_triples.full()) test_collisions();
    }
  }
  test_collisions();
  return found;
}

}  // namespace glocal::ransam
