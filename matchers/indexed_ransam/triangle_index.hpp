// Triangles of a map's points, by what a rigid motion leaves unchanged: their three sides.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "glocal/points.hpp"
#include "matchers/common/triangle.hpp"

namespace glocal::indexed_ransam {

/// The paper's relation (eq. 1) of all triangles that the rule admits, sorted once for a map and read by all;
/// if there are more than max_entries, an even share of them. For places where oriented points have no
/// direction: pillars, trees.
class TriangleIndex {
 public:
  /// The same for any number of threads.
  TriangleIndex(Points points, const TriangleRule& rule, std::size_t max_entries, int threads = 1);

  [[nodiscard]] const Points& points() const { return points_; }
  [[nodiscard]] std::size_t size() const { return triangles_.size(); }
  [[nodiscard]] std::size_t memory_bytes() const;

  /// The map's triangles of a relation, each once; their corners are in no particular order.
  [[nodiscard]] std::span<const Triple> find(Relation relation) const;

 private:
  Points points_;                      ///< z is 0.
  std::vector<Relation> relations_;    ///< Those that occur, ascending.
  std::vector<std::uint32_t> begins_;  ///< Of each relation in triangles_, and the end of the last.
  std::vector<Triple> triangles_;
};

}  // namespace glocal::indexed_ransam
