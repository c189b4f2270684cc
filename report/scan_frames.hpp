// The scans of a trial's steps, one after the other.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "report/millimetres.hpp"

namespace glocal {

/// The scans of steps 0, 1, 2 … Where they have too many points only those of every 2nd, 4th … step are kept.
class ScanFrames {
 public:
  /// At most so many points, unless the first scan alone has more.
  explicit ScanFrames(std::size_t most) : most_(most) {}

  /// What the next step's scan has hit, in the robot's frame. In space at most 4,000 points of it are kept
  /// (thinned_in_space).
  void add(const Points& hits);

  /// Allows fewer points from now on.
  void keep_at_most(std::size_t most);

  /// {"steps", "first", "x", "y"}, and "z" if any point is above or below 0: the points of frame i are those
  /// from first[i] up to first[i + 1].
  [[nodiscard]] nlohmann::ordered_json to_json() const;

 private:
  void leave_out_every_other();

  std::size_t most_;
  std::size_t added_ = 0;   ///< Steps.
  std::size_t stride_ = 1;  ///< Steps from one frame to the next.
  std::vector<std::size_t> first_ = {0};
  std::vector<int> x_, y_, z_;
};

}  // namespace glocal
