// Pairs of surfels, and what does not change when they are moved.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "glocal/rng.hpp"
#include "matchers/surfels/rigid_motion.hpp"
#include "matchers/surfels/surfels.hpp"

namespace glocal::surfels {

/// Two surfels, by their indexes, in the order in which they are compared.
struct SurfelPair {
  std::uint32_t first = 0, second = 0;
};

/// Which pairs are drawn, and how finely their relations are told apart.
struct PairRule {
  float shortest = 1.0F, longest = 8.0F;  ///< m
  float length_cell = 0.2F;               ///< m
  bool both_sides = false;                ///< Normals may point to either side of a surface.
};

/// The relation of a pair: its length, the angles of both normals to the line between, and the twist between
/// the normals about that line (Drost et al. 2010 have the same features but the twist's sign). Cells of 10
/// degrees, in one number.
using PairRelation = std::uint64_t;

/// None for a pair that fixes no pose: normals nearly parallel to each other, or to the line between. May
/// swap the two.
[[nodiscard]] std::optional<PairRelation> relation_of(const Surfels& surfels, SurfelPair& pair,
                                                      const PairRule& rule);

/// Draws pairs of surfels by their weights.
class PairSampler {
 public:
  PairSampler(const Surfels& surfels, const PairRule& rule);
  /// A pair, and its relation; none if this draw gave no pair to use.
  [[nodiscard]] std::optional<std::pair<SurfelPair, PairRelation>> draw(Rng& rng) const;

 private:
  const Surfels* surfels_;
  PairRule rule_;
  std::vector<std::uint32_t> by_weight_;  ///< Each surfel as often as its weight says.
};

/// Drawn pairs of a cloud by their relation.
class PairTable {
 public:
  PairTable(const Surfels& surfels, const PairRule& rule, std::size_t pairs, Rng rng);

  /// Pairs whose relation is perhaps the same.
  [[nodiscard]] std::span<const SurfelPair> find(PairRelation relation) const;
  [[nodiscard]] std::size_t size() const { return pairs_.size(); }
  [[nodiscard]] std::size_t memory_bytes() const {
    return starts_.size() * sizeof(std::uint32_t) + pairs_.size() * sizeof(SurfelPair);
  }

 private:
  [[nodiscard]] std::size_t bucket_of(PairRelation relation) const;

  int bucket_bits_;
  std::vector<std::uint32_t> starts_;  ///< Of each bucket in pairs_, and the end of the last.
  std::vector<SurfelPair> pairs_;
};

/// The motion that brings one pair onto another of the same relation.
[[nodiscard]] RigidMotion motion_between(const Surfels& source, const SurfelPair& a, const Surfels& target,
                                         const SurfelPair& b, bool both_sides);

}  // namespace glocal::surfels
