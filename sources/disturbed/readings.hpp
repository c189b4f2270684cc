// A scan as its readings: what disturbances work on.
#pragma once

#include <vector>

#include "glocal/observation.hpp"

namespace glocal::disturbed {

/// One ray of a scan.
struct Reading {
  Point end;           ///< m, in the robot's frame.
  float range = 0.0F;  ///< From the sensor to `end`, m.
  bool is_hit = true;  ///< Whether it met something there.
  float time = 0.0F;   ///< s after the observation's stamp, where the scan has times.
};

/// All rays of a scan: those that met something in beam order, then the others.
class Readings {
 public:
  explicit Readings(const Scan& scan);

  [[nodiscard]] std::vector<Reading>& all() { return readings_; }
  [[nodiscard]] const std::vector<Reading>& all() const { return readings_; }
  /// Where all rays begin.
  [[nodiscard]] const Point& origin() const { return origin_; }
  /// The farthest range of any ray, m; 0 without any.
  [[nodiscard]] float farthest() const;
  /// The direction of a ray seen from above, rad, in (-pi, pi].
  [[nodiscard]] float bearing(const Reading& reading) const;
  /// How far a ray looks up, in whole degrees: those of one ring of a lidar have the same.
  [[nodiscard]] int ring(const Reading& reading) const;
  /// Moves the ray's end along the ray; one that would be before the sensor is at it.
  void set_range(Reading& reading, float range) const;
  /// They are as if they had never been measured.
  template <class Predicate>
  void lose_if(Predicate predicate) {
    std::erase_if(readings_, predicate);
  }

  [[nodiscard]] Scan scan() const;

 private:
  Point origin_;
  bool has_times_;
  std::vector<Reading> readings_;
};

}  // namespace glocal::disturbed
