// Cells of a grid of poses, by number.
#pragma once

#include <cmath>
#include <cstdint>

#include "glocal/pose2.hpp"

namespace glocal {

/// How large the cells are.
struct PoseCellSize {
  double metres = 0.0;
  double radians = 0.0;
};

/// The number of the cell a pose lies in: different ones for different cells of any map that is less than 16
/// million cells wide.
[[nodiscard]] inline std::uint64_t pose_cell(const Pose2& pose, const PoseCellSize& size) {
  const auto cell = [](double value, double side) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(value / side)));
  };
  const std::uint64_t column = cell(pose.x, size.metres);
  const std::uint64_t row = cell(pose.y, size.metres);
  const std::uint64_t turn = cell(pose.theta, size.radians);
  constexpr std::uint64_t bits = 24;
  constexpr std::uint64_t mask = (std::uint64_t{1} << bits) - 1;
  return turn << (2 * bits) | (row & mask) << bits | (column & mask);
}

}  // namespace glocal
