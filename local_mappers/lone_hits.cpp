#include "local_mappers/lone_hits.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace glocal::local_mappers {
namespace {

/// Neighbours on each side that may confirm a hit: some of them are lost, or alone themselves.
constexpr std::size_t neighbours = 3;
/// What noise may put between two hits of one surface, m.
constexpr float noise = 0.15F;
/// 1 / sin of the flattest angle at which a surface is seen.
constexpr float stretch = 3.0F;

/// Whether two hits can be of one surface: they are no farther apart than the angle between their beams
/// allows.
bool are_joined(const Points& hits, std::size_t i, std::size_t j, const Point& sensor) {
  const float ax = hits.x[i] - sensor.x;
  const float ay = hits.y[i] - sensor.y;
  const float bx = hits.x[j] - sensor.x;
  const float by = hits.y[j] - sensor.y;
  const float range = std::sqrt(ax * ax + ay * ay);
  const float between = std::abs(std::atan2(ax * by - ay * bx, ax * bx + ay * by));
  return std::hypot(bx - ax, by - ay) <= noise + stretch * range * between;
}

}  // namespace

std::vector<bool> lone_hits(const Points& hits, const Point& sensor) {
  const std::size_t n = hits.size();
  std::vector<bool> lone(n, true);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < std::min(n, i + 1 + neighbours); ++j) {
      if ((lone[i] || lone[j]) && are_joined(hits, i, j, sensor)) lone[i] = lone[j] = false;
    }
  }
  return lone;
}

}  // namespace glocal::local_mappers
