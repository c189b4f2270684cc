// How noisy the robot's ranges are, as its scans tell.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "glocal/observation.hpp"

namespace glocal {

/// Estimates the standard deviation of ranges from scans alone, whatever place they are of: from how far each
/// hit lies, along its ray, before or behind the line through both its neighbours. On a wall that is noise
/// alone, whatever the angle between the beams. A low quantile counts, so that corners, furniture and
/// readings that are anything do not.
class RangeNoise {
 public:
  /// Takes in a scan of the plane, with its hits in beam order.
  void take_in(const Scan& scan);
  /// m; none before there were enough hits with neighbours within a few degrees.
  [[nodiscard]] std::optional<double> deviation() const;

 private:
  static constexpr double bin = 0.005;  ///< m
  static constexpr std::size_t bins = 200;
  std::array<std::size_t, bins> counts_{};  ///< Of distances to the line, by size.
  std::size_t size_ = 0;
};

}  // namespace glocal
