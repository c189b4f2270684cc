// What beams say against a pose: a beam cannot have passed through a wall.
#pragma once

#include <cstddef>
#include <deque>

#include "glocal/local_map.hpp"
#include "glocal/observation.hpp"
#include "glocal/occupancy_grid.hpp"

namespace glocal {

struct BeamRule {
  int scans = 5;        ///< The latest ones count.
  int beams = 40;       ///< Of each, spread evenly.
  double margin = 0.3;  ///< m; the last part of a beam before its hit, where a wall may well be.
};

/// Beams of the latest scans in the local frame. Only cells known to be occupied stop a beam; unknown ones
/// say nothing.
class BeamEvidence {
 public:
  explicit BeamEvidence(const BeamRule& rule) : rule_(rule) {}

  /// Takes in a scan, made where the robot is now.
  void add(const LocalMap& local, const Scan& scan);
  void clear() { scans_.clear(); }

  /// Share of the beams that would have passed through occupied cells; 0 without any beam.
  [[nodiscard]] double blocked_share(const OccupancyGrid& grid, const Pose2& map_from_local) const;

 private:
  struct Beams {
    Point origin;
    Points ends;
  };
  BeamRule rule_;
  std::deque<Beams> scans_;
  int generation_ = 0;  ///< Of the local map whose frame they are in.
};

}  // namespace glocal
