// Triples of points, the relation that a rigid motion leaves unchanged, and the motion between two triples
// (Section II of the paper, eq. 1 to 3), for batches of them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "glocal/points.hpp"

namespace glocal {

/// Three indexes into a point set.
using Triple = std::array<std::uint32_t, 3>;

/// As many draws as a MotionBatch has motions. Only the first `size` entries count; the others are zero or
/// left over, but always valid.
struct TripleBatch {
  static constexpr std::size_t capacity = MotionBatch::capacity;
  using Column = std::array<std::uint32_t, capacity>;

  std::size_t size = 0;
  alignas(64) Column numbers{};  ///< Which draws they are.
  alignas(64) Column first{};    ///< Indexes of their points.
  alignas(64) Column second{};
  alignas(64) Column third{};

  void clear() { size = 0; }
  [[nodiscard]] bool full() const { return size == capacity; }
  void add_number(std::uint32_t number) { numbers[size++] = number; }
  /// A triple that is known, with its place in the batch as number.
  void add(const Triple& triple) {
    first[size] = triple[0];
    second[size] = triple[1];
    third[size] = triple[2];
    add_number(static_cast<std::uint32_t>(size));
  }
};

/// The quantised side lengths of a triangle, longest first, then counter-clockwise: 10 bits each in units of
/// a relation cell.
using Relation = std::uint32_t;
inline constexpr unsigned relation_side_bits = 10;
inline constexpr unsigned relation_bits = 3 * relation_side_bits;

/// Which triangles are worth a relation.
struct TriangleRule {
  double cell = 0.1;        ///< Side lengths that differ by less can have the same relation, m.
  double min_side = 0.3;    ///< Shorter sides give poor poses, m.
  double min_height = 0.1;  ///< So do flat triangles: the height over the longest side, m.
  double max_side = 100.0;  ///< Longer sides cannot occur on the other side, m; at most largest_side(cell).
};

/// The longest side a relation can hold, m; one cell less, so that a neighbouring cell is one too.
[[nodiscard]] constexpr double largest_side(double cell) {
  return cell * ((1U << relation_side_bits) - 2U);
}

/// Relations of triples, and of which: of one batch with all its probes, or of as many batches with one each.
struct RelationBatch {
  static constexpr std::size_t probes = 8;
  /// The last entries are room for a vector that is stored whole.
  static constexpr std::size_t capacity = probes * TripleBatch::capacity + 64;

  std::size_t size = 0;
  alignas(64) std::array<Relation, capacity> relations;
  alignas(64) std::array<std::uint32_t, capacity> numbers;  ///< Of the draw.
};

/// Adds the relations of those triples the rule admits. A triangle's sides are put in an order that does not
/// depend on the order of drawing; mirrored triangles have different relations, as a motion in the plane
/// cannot rotate one into the other. Heights play no part: a robot on a floor does not change them. Triples
/// with the same point twice are never admitted. The same for all instruction sets.
/// With `neighbours`, each triple has eight relations instead of one: each side in its own and in the nearer
/// neighbouring cell, so that a side near a cell's boundary meets its partner on the other side.
/// Timed by bench_hashing.
void find_relations(const Points& points, const TripleBatch& batch, const TriangleRule& rule, bool neighbours,
                    RelationBatch& relations);

/// For each i, the motion that moves triple i of `from` onto triple i of `to` with the least sum of squares
/// (eq. 3, with centroids; closed form in two dimensions), both with their sides in the order of relations.
/// Both batches have the same size. The same for all instruction sets.
void least_squares_motions(const Points& from_points, const TripleBatch& from, const Points& to_points,
                           const TripleBatch& to, MotionBatch& motions);

}  // namespace glocal
