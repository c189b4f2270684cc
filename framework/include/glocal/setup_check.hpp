// Notices a robot that is set up wrongly, by its scans and its odometry.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>

#include "glocal/local_map.hpp"
#include "glocal/observation.hpp"
#include "glocal/params.hpp"
#include "glocal/pose2.hpp"
#include "glocal/range_bias.hpp"
#include "glocal/step_result.hpp"
#include "glocal/stuck_ranges.hpp"

namespace glocal {

/// Whether the set-up of the robot is checked, and how sure one must be of it.
struct SetupCheckParams {
  bool enabled = true;
  double min_agreement = 0.0;
};
void describe(ParamVisitor& v, SetupCheckParams& p);

/// Compares how the local map has moved the robot, following the scans, with how odometry has, and looks at
/// the ranges themselves. Works in the plane. Where the local mapper believes odometry, since a scan did not
/// fit or it never looks, the step says nothing of motions.
class SetupMonitor {
 public:
  explicit SetupMonitor(const SetupCheckParams& params) : params_(params) {}

  /// What all steps since reset() say, with this one: the local map has taken in the observation.
  [[nodiscard]] SetupCheck update(const Observation& observation, const LocalMap& local);

  void reset();

 private:
  /// The last observation.
  struct Last {
    Points hits;
    Pose2 odom_from_robot;
    Pose2 local_from_robot;
    int epoch = 0;
  };
  /// From one observation to the next.
  struct Motions {
    Pose2 odometry;
    std::optional<Pose2> scans;  ///< None where the scans told none.
    bool is_repeated = false;    ///< The same scan, though the robot moved.
  };
  [[nodiscard]] Motions motions_since(const Last& last, const Observation& observation,
                                      const LocalMap& local) const;
  void weigh(const Motions& motions);
  [[nodiscard]] SetupCheck measured() const;
  /// Whether scans came again so often of late.
  [[nodiscard]] bool is_repeated(std::size_t times) const;
  /// Whether the scans turn as odometry does in a mirror, and differ from it by so much in all.
  [[nodiscard]] bool is_mirrored(double turned_rad) const;
  /// By how many observations the scans are late; none if that explains nothing.
  [[nodiscard]] std::optional<std::size_t> lag() const;
  [[nodiscard]] std::optional<SetupFault> fault(const SetupCheck& check) const;
  [[nodiscard]] bool is_in_doubt(const SetupCheck& check) const;

  SetupCheckParams params_;
  std::optional<Last> last_;
  std::deque<Motions> motions_;  ///< The latest ones.
  std::size_t steps_ = 0;        ///< Motions since reset().
  double agreement_ = 0.0;       ///< SetupCheck::agreement.
  RangeBias bias_;
  std::optional<Pose2> bias_told_at_;  ///< odom_from_robot where walls were last looked at.
  StuckRanges stuck_;
};

}  // namespace glocal
