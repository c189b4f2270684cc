// All pairs of surface points of a map, by what a rigid motion leaves unchanged.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "matchers/common/surfaces.hpp"
#include "matchers/indexed_ransam/saved_index.hpp"

namespace glocal {

/// Which pairs of points are worth an entry, and how alike two of them are that share a bin.
struct DipoleRule {
  double min_length = 0.5;   ///< m
  double max_length = 6.0;   ///< m
  double length_cell = 0.1;  ///< m
  int angle_cells = 24;      ///< In a full turn.
  std::size_t max_entries = 1'000'000;
};

/// Ordered pairs of oriented points (Winkelbach et al. 2006: dipoles), in bins of their distance and of the
/// two angles between their normals and the line from the first to the second. Built once for a map and read
/// by all; if there are more pairs than max_entries, an even share of them.
class DipoleIndex {
 public:
  static constexpr const char* kind = "dipoles";

  struct Dipole {
    std::uint32_t first;
    std::uint32_t second;
  };

  /// The same for any number of threads.
  DipoleIndex(Surfaces surfaces, const DipoleRule& rule, int threads = 1);
  /// Reads what saved() left. Throws ConfigError where it is no index for this rule.
  DipoleIndex(const SavedIndex& saved, const DipoleRule& rule);

  /// The content of a file that holds the index.
  [[nodiscard]] std::string saved(const IndexOrigin& origin) const;

  [[nodiscard]] const Surfaces& surfaces() const { return surfaces_; }
  [[nodiscard]] std::size_t size() const { return dipoles_.size(); }
  [[nodiscard]] std::size_t memory_bytes() const;

  /// Dipoles of the map in the bin of a dipole of other surfaces; empty if it is too short or too long.
  [[nodiscard]] std::span<const Dipole> find(const Surfaces& surfaces, const Dipole& dipole) const;

 private:
  [[nodiscard]] std::size_t bins() const;
  [[nodiscard]] std::optional<std::uint32_t> bin(const Surfaces& surfaces, const Dipole& dipole) const;

  Surfaces surfaces_;
  DipoleRule rule_;
  SharedArray<std::uint32_t> begins_;  ///< Of each bin in dipoles_, and the end of the last.
  SharedArray<Dipole> dipoles_;
};

}  // namespace glocal
