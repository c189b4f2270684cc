// Whether a scan can have been made where the scans before it were made.
#pragma once

#include <cstddef>
#include <deque>

#include "local_mappers/range_profile.hpp"

namespace glocal::local_mappers {

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
  /// Of the latest scan; there is one.
  [[nodiscard]] const RangeProfile& latest() const { return scans_.back().profile; }
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
