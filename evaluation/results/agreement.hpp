// Whether declared poses agree with each other where no reference can judge them.
#pragma once

#include <cstddef>
#include <vector>

#include "glocal/pose3.hpp"

namespace glocal {

/// A pose as it was declared, and where odometry had the robot then.
struct Declaration {
  double at_m = 0.0;  ///< Along the drive.
  int segment = 0;    ///< Odometry goes on within one only.
  Pose3 map_from_robot = {}, odom_from_robot = {};
};

struct Agreement {
  std::size_t pairs = 0;              ///< Neighbours along the drive, of one segment.
  std::vector<double> disagree_at_m;  ///< The later one of each pair that does not agree.
};

/// Carries each declared pose on to the next one by odometry. Two agree if they then differ by at most 0.5 m
/// and a tenth of the way between them, and by 10 deg and 2 deg for each metre.
[[nodiscard]] Agreement agreement_of(std::vector<Declaration> declarations);

}  // namespace glocal
