// By how much the robot's ranges are too long, as its scans tell.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "glocal/readings.hpp"

namespace glocal {

/// Estimates what is added to each range from scans alone, whatever place they are of: ranges to a straight
/// wall that are all too long by the same make it bulge, and the more so the wider the angle under which it
/// is seen. A wall counts if it is straight over 60 degrees once the bulge is taken away. Doors and things
/// that lean on walls look like bulges, too, to either side, so the median of many walls counts.
class RangeBias {
 public:
  void take_in(const ReadingByDirection& readings);
  /// Straight walls so far; one that is seen from several poses counts for each.
  [[nodiscard]] std::size_t walls() const { return walls_; }
  /// By which ranges are too long, m, in [-1, 1]; none before there was a wall.
  [[nodiscard]] std::optional<double> median() const;

 private:
  static constexpr double bin = 0.01;  ///< m
  static constexpr std::size_t bins = 201;
  std::array<std::size_t, bins> counts_{};  ///< Of biases from -1 m on.
  std::size_t walls_ = 0;
};

}  // namespace glocal
