// A local map of what was seen last: it forgets, and so neither grows nor drags old drift along.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "glocal/params.hpp"
#include "glocal/strategies.hpp"
#include "local_mappers/moving_along.hpp"
#include "local_mappers/scan_matching.hpp"

namespace glocal::local_mappers {

/// Matches scans as scan_matching does, against a map of the last `scans` observations or `distance` metres
/// of way, whichever is less. The map is what these observations alone would give, registered where they were
/// placed: points that only older ones hit are gone, and a cell's point belongs to the first observation that
/// is left of those that hit it. Hits that stand alone in their scan (lone_hits.hpp), and those on what
/// moves along with the robot (moving_along.hpp), are not registered, and those that two later scans have
/// looked through are taken out: what was there has gone, or never was. Frame and epoch stay.
///
/// Time and memory for an observation depend on what the window holds, not on the drive before it.
class Bounded final : public LocalMapper {
 public:
  struct Params {
    int scans = 60;
    double distance = 10.0;
    ScanMatching::Params matching = {};
  };

  explicit Bounded(const Params& params) : params_(params), matching_(params.matching) {}

  void add(const Observation& observation) override;
  [[nodiscard]] const LocalMap& map() const override { return matching_.map(); }
  void reset() override;

  /// Index of the points, for looking at how much the map takes.
  [[nodiscard]] const PointGrid& grid() const { return matching_.grid(); }

 private:
  /// An observation in the window.
  struct Placed {
    LocalScan scan;
    double way = 0.0;  ///< Driven up to here, m.
    /// For each hit, later scans that looked through it, less those that met it.
    std::vector<std::uint8_t> gone = {};
  };
  /// Adds what the robot sees of the place where it is.
  void add_place(const Observation& observation);
  /// Takes out what a scan, made where the robot is, shows to be gone. Whether that was anything.
  bool take_out_gone(const RangeProfile& now);
  [[nodiscard]] bool is_too_long() const;

  Params params_;
  ScanMatching matching_;
  MovingAlong moving_along_;
  std::deque<Placed> window_;  ///< All observations of the map, oldest first.
};
void describe(ParamVisitor& v, Bounded::Params& p);

}  // namespace glocal::local_mappers
