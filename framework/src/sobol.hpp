// Points that fill a unit cube evenly: Sobol's sequence.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace glocal {

/// Sobol's sequence, with the direction numbers of S. Joe and F. Y. Kuo, "Constructing Sobol sequences with
/// better two-dimensional projections", SIAM J. Sci. Comput. 30 (2008) 2635-2654: the first lines of their
/// file new-joe-kuo-6. Of the first 2^m points, each dimension has exactly one in each of 2^m equal parts.
class Sobol {
 public:
  static constexpr std::size_t most_dimensions = 37;

  /// From 1 to most_dimensions.
  explicit Sobol(std::size_t dimensions);

  /// Point number `index` in the order of Gray's code, as Joe and Kuo list them; the first one, 0, is the
  /// cube's corner. Coordinates are in units of 2^-32.
  [[nodiscard]] std::vector<std::uint32_t> point(std::uint32_t index) const;

 private:
  static constexpr std::size_t bits = 32;
  std::vector<std::vector<std::uint32_t>> directions_;  ///< Of each dimension one for each bit.
};

}  // namespace glocal
