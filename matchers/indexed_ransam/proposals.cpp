#include "matchers/indexed_ransam/proposals.hpp"

#include <algorithm>
#include <cstdint>
#include <variant>
#include <vector>

#include "matchers/common/point_pair.hpp"
#include "matchers/common/triple_sampler.hpp"

namespace glocal::indexed_ransam {
namespace {

using OrientedPair = OrientedPairIndex::OrientedPair;

/// Two points drawn until their distance is in range: in a large local map most pairs are too far apart.
/// Given up after some tries.
OrientedPair draw_pair(const OrientedPoints& s, const OrientedPairRule& rule, Rng& rng) {
  constexpr int most_tries = 32;
  const auto n = static_cast<std::uint32_t>(s.size());
  OrientedPair pair{};
  for (int i = 0; i < most_tries; ++i) {
    pair = {rng.below(n), rng.below(n)};
    const float dx = s.x[pair.second] - s.x[pair.first];
    const float dy = s.y[pair.second] - s.y[pair.first];
    const double squared = dx * dx + dy * dy;
    if (squared >= rule.min_length * rule.min_length && squared < rule.max_length * rule.max_length) break;
  }
  return pair;
}

PointPair ends_of(const OrientedPoints& s, const OrientedPair& pair) {
  return {Point{s.x[pair.first], s.y[pair.first]}, Point{s.x[pair.second], s.y[pair.second]}};
}

void prefetch(const OrientedPoints& s, const OrientedPair& pair) {
  for (const std::uint32_t i : {pair.first, pair.second}) {
    __builtin_prefetch(&s.x[i]);
    __builtin_prefetch(&s.y[i]);
  }
}

/// Poses that one oriented point pair proposes at most, one for each even part of its partners. A pose takes
/// less time than another pair, and a pair with few partners is soon through with them: what is rare tells
/// most.
constexpr std::uint32_t most_partners = 8;

void propose_by(const OrientedPairIndex& index, const RelationRule& rule, const LocalMap& local,
                std::size_t most_poses, Rng& rng, const TakePoses& take) {
  const OrientedPoints points = oriented_points_of(local, rule.points);
  if (points.size() < 2) return;
  // A large index is not in the cache: what a block of draws needs is fetched while others are at work.
  constexpr std::size_t block = 64;
  struct Draw {
    OrientedPair pair;
    const OrientedPair* partner;
  };
  std::vector<Draw> drawn;
  drawn.reserve(block * most_partners);
  MotionBatch motions;
  std::size_t size = 0;
  const std::size_t draws = (most_poses + most_partners - 1) / most_partners;
  for (std::size_t i = 0; i < draws; i += block) {
    drawn.clear();
    for (std::size_t k = i; k < std::min(draws, i + block); ++k) {
      const OrientedPair pair = draw_pair(points, rule.pairs, rng);
      const auto partners = index.find(points, pair);
      const auto all = static_cast<std::uint32_t>(partners.size());
      const std::uint32_t parts = std::min(all, most_partners);
      for (std::uint32_t part = 0; part < parts; ++part) {
        const auto begin = static_cast<std::uint32_t>(std::uint64_t{part} * all / parts);
        const auto end = static_cast<std::uint32_t>((std::uint64_t{part} + 1) * all / parts);
        drawn.push_back({pair, &partners[begin + rng.below(end - begin)]});
        __builtin_prefetch(drawn.back().partner);
      }
    }
    for (const Draw& draw : drawn) prefetch(index.oriented_points(), *draw.partner);
    for (const Draw& draw : drawn) {
      lay(ends_of(points, draw.pair), ends_of(index.oriented_points(), *draw.partner), motions, size++);
      if (size < MotionBatch::capacity) continue;
      take(motions, size);
      size = 0;
    }
  }
  take(motions, size);
}

/// The second and third point near the first, as in the map's triangles: farther ones would have no partner.
void propose_by(const TriangleIndex& index, const RelationRule& rule, const LocalMap& local,
                std::size_t draws, Rng& rng, const TakePoses& take) {
  const Points points = downsampled_in_plane(local.points, rule.points.voxel_size);
  const TriangleRule triangles = rule.triangles();
  const TripleSampler sampler(points, triangles.max_side);
  const std::uint64_t seed = rng.next();
  RelationBatch relations;
  TripleBatch drawn;
  TripleBatch from;
  TripleBatch to;
  MotionBatch motions;
  for (std::size_t begin = 0; begin < draws; begin += TripleBatch::capacity) {
    drawn.clear();
    for (std::size_t i = begin; i < std::min(draws, begin + TripleBatch::capacity); ++i) {
      drawn.add_number(static_cast<std::uint32_t>(i));
    }
    sampler.draw(seed, drawn);
    relations.size = 0;
    find_relations(points, drawn, triangles, false, relations);
    from.clear();
    to.clear();
    for (std::size_t i = 0; i < relations.size; ++i) {
      const auto partners = index.find(relations.relations[i]);
      if (partners.empty()) continue;
      const std::size_t n = relations.numbers[i] - begin;
      from.add({drawn.first[n], drawn.second[n], drawn.third[n]});
      to.add(partners[rng.below(static_cast<std::uint32_t>(partners.size()))]);
    }
    least_squares_motions(points, from, index.points(), to, motions);
    take(motions, from.size);
  }
}

}  // namespace

void propose(const RelationIndex& index, const RelationRule& rule, const LocalMap& local,
             std::size_t most_poses, Rng& rng, const TakePoses& take) {
  std::visit([&](const auto& one) { propose_by(one, rule, local, most_poses, rng, take); }, index);
}

}  // namespace glocal::indexed_ransam
