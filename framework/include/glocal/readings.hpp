// A scan of the plane as its sensor measures it.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "glocal/observation.hpp"

namespace glocal {

/// A hit, seen from the sensor.
struct PolarReading {
  double range = 0.0;  ///< m
  double angle = 0.0;  ///< rad, in [-pi, pi]; of a robot that stands upright, to the left of its front.
};

/// In the order of the hits.
[[nodiscard]] std::vector<PolarReading> readings_of(const Scan& scan);

/// The mean reading of each direction 2 degrees wide, all around from the front to the left; none where
/// nothing was hit.
constexpr std::size_t directions = 180;
using ReadingByDirection = std::array<std::optional<PolarReading>, directions>;
[[nodiscard]] ReadingByDirection by_direction(const std::vector<PolarReading>& readings);

}  // namespace glocal
