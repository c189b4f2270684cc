// How far a scan saw, direction by direction.
#pragma once

#include <cstddef>
#include <vector>

#include "glocal/observation.hpp"

namespace glocal::local_mappers {

/// How far a scan saw in each direction from its sensor.
class RangeProfile {
 public:
  explicit RangeProfile(const Scan& scan);

  /// A beam that went on for less than this behind a hit may have met the same thing, m.
  static constexpr float margin = 0.3F;

  /// How far it saw towards a point, from its sensor, m; 0 if no beam went there.
  [[nodiscard]] float range_towards(const Point& p) const;

  /// What this scan says of a place: its beams did not come there, met something there, or passed through and
  /// met nothing for `margin` more.
  enum class View { none, met, passed };
  /// `p`: in the frame of this scan's robot.
  [[nodiscard]] View view_of(const Point& p) const;

  /// Hits of another scan, counted by what this one says of them; those it could not see are in neither.
  struct Seen {
    std::size_t met = 0;        ///< Beams met something there, too.
    std::size_t violation = 0;  ///< Beams passed through there, and met nothing for `margin` more.
  };
  /// `here_from_hits`: from the frame of the hits to that of this scan's robot.
  [[nodiscard]] Seen look_at(const Points& hits, const Pose2& here_from_hits) const;

 private:
  Point origin_;
  std::vector<float> ranges_;  ///< m, the nearest end of a beam in each direction; 0 without any.
};

}  // namespace glocal::local_mappers
