// Which ranges do not change though the robot moves.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "glocal/pose2.hpp"
#include "glocal/readings.hpp"

namespace glocal {

/// Finds directions of the sensor in which the range has stayed the same while the robot drove on and turned:
/// its driver repeats what it has read. A straight wall beside the way keeps its range, too, but not in a
/// turn. What is nearer than 1 m may move along, and does not count.
class StuckRanges {
 public:
  /// Takes in a scan, and where odometry is.
  void take_in(const std::vector<PolarReading>& readings, const Pose2& odom_from_robot);
  /// Of the last scan's directions, half a degree wide, those that are stuck; 0 for a scan without hits.
  [[nodiscard]] double share() const { return share_; }

 private:
  /// Since when a direction has the same range.
  struct Since {
    double range = -1.0;  ///< m; less than 0 before the first.
    Pose2 odom_from_robot;
    bool has_turned = false, has_driven = false;
  };
  static constexpr std::size_t cells = 720;
  std::array<Since, cells> since_{};  ///< By direction; the first reading in each counts.
  double share_ = 0.0;
};

}  // namespace glocal
