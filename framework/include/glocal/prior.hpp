// What is known beforehand of where the robot was when a trial began.
#pragma once

#include <optional>
#include <string>

#include "glocal/global_map.hpp"
#include "glocal/local_map.hpp"
#include "glocal/params.hpp"
#include "glocal/pose3.hpp"

namespace glocal {

/// A disc of the map, seen from above: all of its numbers are given, or none.
struct StartRegion {
  std::optional<double> x, y, radius;  ///< m

  [[nodiscard]] bool is_given() const { return radius.has_value(); }
  /// Whether a rectangle along the axes, from low to high, has a part in the region, which is given.
  [[nodiscard]] bool meets(double low_x, double low_y, double high_x, double high_y) const;
};
void describe(ParamVisitor& v, StartRegion& p);

/// A range of headings: both numbers are given, or none.
struct StartHeading {
  std::optional<double> deg;        ///< Of its middle.
  std::optional<double> width_deg;  ///< Half of it on either side.

  [[nodiscard]] bool is_given() const { return width_deg.has_value(); }
};
void describe(ParamVisitor& v, StartHeading& p);

/// Where the robot was at the first observation of a trial, and where it looked. Nothing given: it was
/// anywhere.
struct Prior {
  StartRegion region;
  StartHeading heading;

  [[nodiscard]] bool is_given() const { return region.is_given() || heading.is_given(); }
  /// Whether the robot may have begun there.
  [[nodiscard]] bool allows(const Pose3& map_from_start) const;
};
void describe(ParamVisitor& v, Prior& p);

/// The same where places of the map are `by` (m) farther.
[[nodiscard]] Prior shifted(Prior prior, const Vector3& by);

/// "starts within 5 m of x 3, y 4 with headings of 90 ± 20 deg"; something is given.
[[nodiscard]] std::string to_string(const Prior& prior);

/// Why no robot can have begun in the prior's region of this map; none if one can, or no region is given. A
/// map with cells needs a free one there; one of points alone a point within 100 m, as far as lidars reach.
[[nodiscard]] std::optional<std::string> why_nowhere(const Prior& prior, const GlobalMap& map);

/// Which poses of a local map a prior leaves.
class PoseGate {
 public:
  /// All of them.
  PoseGate() = default;
  /// Those that put the start of the trial, where it lies in the local map, where the prior has it.
  PoseGate(const Prior& prior, const Pose3& local_from_start)
      : prior_(prior), local_from_start_(local_from_start) {}

  /// Whether it allows every pose.
  [[nodiscard]] bool is_open() const { return !prior_.is_given(); }
  [[nodiscard]] bool allows(const Pose3& map_from_local) const {
    return is_open() || prior_.allows(map_from_local * local_from_start_);
  }

  /// For searches that leave out many poses at once.
  [[nodiscard]] const Prior& prior() const { return prior_; }
  [[nodiscard]] const Pose3& local_from_start() const { return local_from_start_; }

 private:
  Prior prior_;
  Pose3 local_from_start_;
};

/// Follows where a trial began, in the frame of its local map.
class StartInLocalMap {
 public:
  /// Takes in the local map once an observation was added. Where it has begun anew in this step, odometry
  /// says how the robot has moved since the last one.
  void follow(const LocalMap& local, const Pose3& odom_from_robot);
  void reset() { last_.reset(); }

  /// After at least one step.
  [[nodiscard]] const Pose3& local_from_start() const { return local_from_start_; }

 private:
  struct Step {
    Pose3 local_from_robot, odom_from_robot;
    int epoch;
  };
  std::optional<Step> last_;
  Pose3 local_from_start_;
};

}  // namespace glocal
