// What goes wrong with odometry, with the order of things in time, and with how the sensor is mounted.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <utility>

#include "sources/disturbed/disturbance.hpp"

namespace glocal::disturbed {

/// This share of the samples is lost.
class DroppedScans final : public Disturbance {
 public:
  DroppedScans(double share, Rng /*rng*/) : share_(share) {}
  [[nodiscard]] std::optional<Sample> disturb(Sample sample, Rng rng) override;

 private:
  double share_;
};

/// Each scan comes so many samples too late: odometry and reference are those of its arrival. Where a segment
/// begins nothing has arrived yet, and samples are lost.
class LateScans final : public Disturbance {
 public:
  LateScans(double samples, Rng rng);
  [[nodiscard]] std::optional<Sample> disturb(Sample sample, Rng rng) override;

 private:
  std::size_t samples_;
  std::deque<Scan> on_the_way_;
  int segment_ = 0;
};

/// The driver hangs: of so many samples, all have the scan of the first.
class RepeatedScans final : public Disturbance {
 public:
  RepeatedScans(double samples, Rng rng);
  [[nodiscard]] std::optional<Sample> disturb(Sample sample, Rng rng) override;

 private:
  std::size_t samples_, left_ = 0;
  Scan scan_;
};

/// The sensor looks this much, deg, to the left of where it is thought to look.
class MountAngle final : public Disturbance {
 public:
  MountAngle(double angle_deg, Rng /*rng*/) : angle_deg_(angle_deg) {}
  [[nodiscard]] std::optional<Sample> disturb(Sample sample, Rng rng) override;

 private:
  double angle_deg_;
};

/// The sensor hangs upside down, and nobody has said so: left is right.
class UpsideDown final : public Disturbance {
 public:
  UpsideDown(double /*amount*/, Rng /*rng*/) {}
  [[nodiscard]] std::optional<Sample> disturb(Sample sample, Rng rng) override;
};

/// Scans and odometry have left and right the wrong way round: the robot sees and drives in a mirror.
class Mirrored final : public Disturbance {
 public:
  Mirrored(double /*amount*/, Rng /*rng*/) {}
  [[nodiscard]] std::optional<Sample> disturb(Sample sample, Rng rng) override;
};

/// In this share of all directions, a degree wide and high, the first range that is read there stays for
/// ever.
class StuckRanges final : public Disturbance {
 public:
  StuckRanges(double share, Rng rng) : share_(share), rng_(rng) {}
  [[nodiscard]] std::optional<Sample> disturb(Sample sample, Rng rng) override;

 private:
  using Direction = std::pair<std::int64_t, int>;  ///< Bearing and ring, deg.
  double share_;
  Rng rng_;
  std::map<Direction, float> first_range_;  ///< m
};

/// Motions as odometry measures them, made into poses again.
class Odometry : public Disturbance {
 public:
  [[nodiscard]] std::optional<Sample> disturb(Sample sample, Rng rng) final;

 protected:
  /// What is measured of the robot's motion since the sample before.
  [[nodiscard]] virtual Pose3 measured(const Pose3& motion, Rng& rng) const = 0;

 private:
  struct Last {
    Pose3 odom_from_robot;       ///< As it was.
    Pose3 disturbed_from_robot;  ///< As it is told.
  };
  std::optional<Last> last_;
};

/// Ways are measured this much too long, as a share.
class StretchedWays final : public Odometry {
 public:
  StretchedWays(double excess, Rng /*rng*/) : excess_(excess) {}

 private:
  [[nodiscard]] Pose3 measured(const Pose3& motion, Rng& rng) const override;
  double excess_;
};

/// The robot turns to the left by this much, deg/m, and its wheels do not notice.
class PulledAside final : public Odometry {
 public:
  PulledAside(double deg_per_m, Rng /*rng*/) : deg_per_m_(deg_per_m) {}

 private:
  [[nodiscard]] Pose3 measured(const Pose3& motion, Rng& rng) const override;
  double deg_per_m_;
};

/// In this share of the samples the wheels spin: way and turn are measured up to twice as large.
class SpinningWheels final : public Odometry {
 public:
  SpinningWheels(double share, Rng /*rng*/) : share_(share) {}

 private:
  [[nodiscard]] Pose3 measured(const Pose3& motion, Rng& rng) const override;
  double share_;
};

/// In this share of the samples the wheels count backwards.
class ReversedMotions final : public Odometry {
 public:
  ReversedMotions(double share, Rng /*rng*/) : share_(share) {}

 private:
  [[nodiscard]] Pose3 measured(const Pose3& motion, Rng& rng) const override;
  double share_;
};

/// Odometry is of a moment before its scan: by up to this share of the way since the last sample.
class Jitter final : public Disturbance {
 public:
  Jitter(double most, Rng /*rng*/) : most_(most) {}
  [[nodiscard]] std::optional<Sample> disturb(Sample sample, Rng rng) override;

 private:
  double most_;
  std::optional<Pose3> last_;  ///< odom_from_robot as it was.
};

/// In this share of the samples no motion is measured.
class LostMotions final : public Odometry {
 public:
  LostMotions(double share, Rng /*rng*/) : share_(share) {}

 private:
  [[nodiscard]] Pose3 measured(const Pose3& motion, Rng& rng) const override;
  double share_;
};

}  // namespace glocal::disturbed
