// Whether a scan can have been made where the scans before it were made.
#pragma once

#include <cstddef>
#include <deque>
#include <vector>

#include "glocal/observation.hpp"
#include "glocal/params.hpp"

namespace glocal::local_mappers {

struct FreeSpaceCheckParams {
  int scans = 4;
  double margin = 0.3;
  int min_hits = 50;
};
void describe(ParamVisitor& v, FreeSpaceCheckParams& p);

/// How far a scan saw in each direction from its sensor.
class RangeProfile {
 public:
  explicit RangeProfile(const Scan& scan);

  /// Hits of another scan, counted by what this one says of them; those it could not see are in neither.
  struct Seen {
    std::size_t met = 0;        ///< Beams met something there, too.
    std::size_t violation = 0;  ///< Beams passed through there, and met nothing for `margin` more.
  };
  /// `here_from_hits`: from the frame of the hits to that of this scan's robot; `margin` in m.
  [[nodiscard]] Seen look_at(const Points& hits, const Pose2& here_from_hits, double margin) const;

 private:
  Point origin_;
  std::vector<float> ranges_;  ///< m, the nearest end of a beam in each direction; 0 without any.
};

/// The latest scans of a local map. Where one beam passed, another cannot have met a wall: a robot that was
/// carried away without knowing gives itself away by that, even where the scans fit fairly well.
class FreeSpaceCheck {
 public:
  explicit FreeSpaceCheck(const FreeSpaceCheckParams& params) : params_(params) {}

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
  FreeSpaceCheckParams params_;
  std::deque<PlacedScan> scans_;
};

}  // namespace glocal::local_mappers
