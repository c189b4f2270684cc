// All pairs of surface points of a map, by what a rigid motion leaves unchanged.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "matchers/common/oriented_points.hpp"

namespace glocal::indexed_ransam {

/// Which pairs of points are worth an entry, and how alike two of them are that share a bin.
struct OrientedPairRule {
  double min_length = 0.5;              ///< m
  double max_length = 6.0;              ///< m
  double length_cell = 0.1;             ///< m
  int angle_cells = 24;                 ///< In a full turn.
  std::size_t max_entries = 1'000'000;  ///< Of 8 bytes; of triangles 12 to 20.
};

/// Ordered pairs of oriented points (Winkelbach et al. 2006: oriented point pairs), in bins of their distance
/// and of the two angles between their normals and the line from the first to the second. Built once for a
/// map and read by all; if there are more pairs than max_entries, an even share of them.
class OrientedPairIndex {
 public:
  struct OrientedPair {
    std::uint32_t first;
    std::uint32_t second;
  };

  /// The same for any number of threads.
  OrientedPairIndex(OrientedPoints oriented_points, const OrientedPairRule& rule, int threads = 1);

  [[nodiscard]] const OrientedPoints& oriented_points() const { return oriented_points_; }
  [[nodiscard]] std::size_t size() const { return pairs_.size(); }
  [[nodiscard]] std::size_t memory_bytes() const;

  /// Oriented point pairs of the map in the bin of an oriented point pair of other oriented points; empty if
  /// it is too short or too long.
  [[nodiscard]] std::span<const OrientedPair> find(const OrientedPoints& oriented_points,
                                                   const OrientedPair& pair) const;

 private:
  [[nodiscard]] std::size_t bins() const;
  [[nodiscard]] std::optional<std::uint32_t> bin(const OrientedPoints& oriented_points,
                                                 const OrientedPair& pair) const;

  OrientedPoints oriented_points_;
  OrientedPairRule rule_;
  std::vector<std::uint32_t> begins_;  ///< Of each bin in pairs_, and the end of the last.
  std::vector<OrientedPair> pairs_;
};

}  // namespace glocal::indexed_ransam
