// Whether a scan can have been made where the scans before it were made.
#pragma once

#include <cstddef>
#include <deque>
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

/// The latest scans of a local map. Where one beam passed, another cannot have met a wall: a robot that was
/// carried away without knowing gives itself away by that, even where the scans fit fairly well.
class FreeSpaceCheck {
 public:
  /// Latest scans that a new one is compared with.
  static constexpr std::size_t scans = 4;
  /// With fewer hits in common view nothing is said.
  static constexpr std::size_t min_hits = 50;

  /// Of the hits that the latest scans could see from where they were made, and of theirs that `scan` could
  /// see, made at `local_from_robot`: the share seen through; 0 if there are too few to say.
  [[nodiscard]] double violation(const Scan& scan, const Pose2& local_from_robot) const;

  void add(const Scan& scan, const Pose2& local_from_robot);
  void clear() { scans_.clear(); }

 private:
  struct PlacedScan {
    Pose2 local_from_robot;
    Points hits;
    RangeProfile profile;
  };
  std::deque<PlacedScan> scans_;
};

}  // namespace glocal::local_mappers
