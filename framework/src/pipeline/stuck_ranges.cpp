#include "glocal/stuck_ranges.hpp"

#include <cmath>
#include <numbers>
#include <utility>

namespace glocal {
namespace {

/// Ranges that differ by less are the same, m.
constexpr double same_range = 0.015;
/// What the robot must have done meanwhile.
constexpr double turned_by = radians(25.0);
constexpr double driven_by = 0.5;

/// What is nearer, m, may move along: parts of the robot, or somebody beside it.
constexpr double least_range = 1.0;

/// Beams lie at whole and half degrees, so that borders of cells must not.
constexpr double offset = radians(0.07);

}  // namespace

void StuckRanges::take_in(const std::vector<PolarReading>& readings, const Pose2& odom_from_robot) {
  std::array<bool, cells> is_seen{};
  std::size_t stuck = 0, seen = 0;
  for (const PolarReading& reading : readings) {
    const double turns = (reading.angle + offset) / (2.0 * std::numbers::pi) + 1.0;
    const std::size_t cell = static_cast<std::size_t>(turns * static_cast<double>(cells)) % cells;
    if (std::exchange(is_seen[cell], true)) continue;
    Since& since = since_[cell];
    if (std::abs(reading.range - since.range) > same_range)
      since = {.range = reading.range, .odom_from_robot = odom_from_robot};
    since.has_turned |= rotation_between(since.odom_from_robot, odom_from_robot) >= turned_by;
    since.has_driven |= distance(since.odom_from_robot, odom_from_robot) >= driven_by;
    ++seen;
    if (since.has_turned && since.has_driven && since.range >= least_range) ++stuck;
  }
  share_ = seen == 0 ? 0.0 : static_cast<double>(stuck) / static_cast<double>(seen);
}

}  // namespace glocal
