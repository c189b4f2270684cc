// What beams say of a pose: one that ends at a wall speaks for it, and none can have passed through a wall.
#pragma once

#include <algorithm>
#include <deque>
#include <limits>

#include "glocal/clearance_grid.hpp"
#include "glocal/contact.hpp"
#include "glocal/local_map.hpp"
#include "glocal/observation.hpp"
#include "glocal/params.hpp"

namespace glocal {

/// Parameters of any matcher that asks beams, among its own.
struct BeamRule {
  double weight = 0.0;  ///< What the share of blocked beams takes off a pose's score.
  double cap = 1.0;     ///< A larger share counts as this one.
  int scans = 5;        ///< The latest ones count.
  int beams = 40;       ///< Of each, spread evenly.
  double margin = 0.3;  ///< m; the last part of a beam before its hit, where a wall may well be.
};
void describe(ParamVisitor& v, BeamRule& p);

/// Beams of the latest scans in the local frame. Only cells known to be occupied stop a beam; unknown ones
/// say nothing.
class BeamEvidence {
 public:
  explicit BeamEvidence(const BeamRule& rule) : rule_(rule) {}

  /// Takes in a scan, made where the robot is now.
  void add(const LocalMap& local, const Scan& scan);
  void clear();

  /// What blocked beams take off the score of a pose. Where that is more than `most`, beams need not all be
  /// looked at: the answer is then above `most` too.
  [[nodiscard]] double penalty(const ClearanceGrid& grid, const Pose2& map_from_local,
                               double most = std::numeric_limits<double>::infinity()) const {
    if (rule_.weight == 0.0) return 0.0;
    return rule_.weight * std::min(rule_.cap, blocked_share(grid, map_from_local, most / rule_.weight));
  }

  /// Share of the beams that would have passed through occupied cells; 0 without any beam. Where it is more
  /// than `most`, beams need not all be looked at: the answer is then above `most` too.
  [[nodiscard]] double blocked_share(const ClearanceGrid& grid, const Pose2& map_from_local,
                                     double most = 1.0) const;

  /// What scans of different places say for a pose: the share of a scan's beams that end at the map, less
  /// twice that of beams through occupied cells, summed over scans. A beam that ends before the map does has
  /// met something new, and says nothing. Scans of a robot that stands still say the same again: but for
  /// the first place, where the first scan and the latest one count, only the latest one does.
  [[nodiscard]] double support(const ContactIndex& contact, const ClearanceGrid& grid,
                               const Pose2& map_from_local) const;

 private:
  struct Beams {
    Pose2 local_from_robot;
    Point origin;
    Points ends;
    std::size_t hits = 0;  ///< The first ones of `ends` met something there.
  };
  BeamRule rule_;
  std::deque<Beams> scans_;   ///< The latest ones.
  std::deque<Beams> places_;  ///< The latest one, and before it one for each place.
  int epoch_ = 0;             ///< Of the local map whose frame they are in.
};

}  // namespace glocal
