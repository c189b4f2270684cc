#include "glocal/range_noise.hpp"

#include <cmath>
#include <vector>

#include "glocal/pose2.hpp"
#include "glocal/readings.hpp"

namespace glocal {
namespace {

/// Neighbours farther apart are hardly ever of one wall.
constexpr double farthest_neighbour = radians(2.6);

/// How far the middle one is, along its ray, from the line through the others, m; none where they are no
/// neighbours.
std::optional<double> off_line(const PolarReading& before, const PolarReading& middle,
                               const PolarReading& after) {
  const double first = wrap_angle(middle.angle - before.angle);
  const double second = wrap_angle(after.angle - middle.angle);
  const auto are_neighbours = [](double angle) {
    return angle != 0.0 && std::abs(angle) <= farthest_neighbour;
  };
  if (!are_neighbours(first) || !are_neighbours(second) || (first > 0.0) != (second > 0.0))
    return std::nullopt;
  // Along a line, 1 / range is a sine of the angle.
  const double inverse =
      (std::sin(second) / before.range + std::sin(first) / after.range) / std::sin(first + second);
  return middle.range - 1.0 / inverse;
}

}  // namespace

void RangeNoise::take_in(const Scan& scan) {
  const std::vector<PolarReading> readings = readings_of(scan);
  for (std::size_t i = 2; i < readings.size(); ++i) {
    if (const auto off = off_line(readings[i - 2], readings[i - 1], readings[i])) {
      const double place = std::abs(*off) / bin;
      if (place < static_cast<double>(bins)) {
        ++counts_[static_cast<std::size_t>(place)];
        ++size_;
      }
    }
  }
}

std::optional<double> RangeNoise::deviation() const {
  constexpr std::size_t enough = 30;
  constexpr double quantile = 0.25;
  // Of a normal distribution's sizes, times that of a hit and of the mean of two neighbours.
  constexpr double deviations_there = 0.3186 * 1.2247;
  if (size_ < enough) return std::nullopt;
  double below = quantile * static_cast<double>(size_);
  std::size_t i = 0;
  while (below > static_cast<double>(counts_[i])) below -= static_cast<double>(counts_[i++]);
  const double place = static_cast<double>(i) + below / static_cast<double>(counts_[i]);
  return place * bin / deviations_there;
}

}  // namespace glocal
