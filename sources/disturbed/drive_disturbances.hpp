// What goes wrong with odometry, with the order of things in time, and with how the sensor is mounted.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <utility>

#include "sources/disturbed/disturbance.hpp"

namespace glocal::disturbed {

using SampleChange = std::optional<Sample>(Sample sample, double amount, Rng& rng);

/// Of kinds that change each sample by itself.
template <SampleChange& change>
class OfEachSample final : public Disturbance {
 public:
  OfEachSample(double amount, Rng /*rng*/) : amount_(amount) {}
  [[nodiscard]] std::optional<Sample> disturb(Sample sample, Rng rng) override {
    return change(std::move(sample), amount_, rng);
  }

 private:
  double amount_;
};

/// This share of the samples is lost.
[[nodiscard]] std::optional<Sample> drop(Sample sample, double share, Rng& rng);
using DroppedScans = OfEachSample<drop>;

/// Each scan comes so many samples too late: odometry and reference are those of its arrival. Where a segment
/// begins nothing has arrived yet, and samples are lost.
class LateScans final : public Disturbance {
 public:
  LateScans(double samples, Rng rng);
  [[nodiscard]] std::optional<Sample> disturb(Sample sample, Rng rng) override;

 private:
  std::size_t samples_;
  std::deque<Scan> on_the_way_;
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
[[nodiscard]] std::optional<Sample> turn_mount(Sample sample, double angle_deg, Rng& rng);
using MountAngle = OfEachSample<turn_mount>;

/// The sensor hangs upside down, and nobody has said so: left is right.
[[nodiscard]] std::optional<Sample> turn_over(Sample sample, double amount, Rng& rng);
using UpsideDown = OfEachSample<turn_over>;

/// Scans and odometry have left and right the wrong way round: the robot sees and drives in a mirror.
[[nodiscard]] std::optional<Sample> mirror(Sample sample, double amount, Rng& rng);
using Mirrored = OfEachSample<mirror>;

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

/// Odometry is of a moment before its scan: by up to this share of the way since the last sample.
class Jitter final : public Disturbance {
 public:
  Jitter(double most, Rng /*rng*/) : most_(most) {}
  [[nodiscard]] std::optional<Sample> disturb(Sample sample, Rng rng) override;

 private:
  double most_;
  std::optional<Pose3> last_;  ///< odom_from_robot as it was, in this segment.
};

/// What is measured of the robot's motion since the sample before.
using Measured = Pose3(const Pose3& motion, double amount, Rng& rng);

/// Motions as odometry measures them, made into poses again.
template <Measured& measured>
class Odometry final : public Disturbance {
 public:
  Odometry(double amount, Rng /*rng*/) : amount_(amount) {}
  [[nodiscard]] std::optional<Sample> disturb(Sample sample, Rng rng) override {
    Pose3& odom_from_robot = sample.observation.odom_from_robot;
    const Pose3 as_it_was = odom_from_robot;
    if (last_) {
      const Pose3 motion = inverse(last_->odom_from_robot) * as_it_was;
      odom_from_robot = last_->disturbed_from_robot * measured(motion, amount_, rng);
    }
    last_ = {as_it_was, odom_from_robot};
    return sample;
  }

 private:
  struct Last {
    Pose3 odom_from_robot;       ///< As it was.
    Pose3 disturbed_from_robot;  ///< As it is told.
  };
  double amount_;
  std::optional<Last> last_;
};

/// Ways are measured this much too long, as a share.
[[nodiscard]] Pose3 stretched(const Pose3& motion, double excess, Rng& rng);
using StretchedWays = Odometry<stretched>;

/// The robot turns to the left by this much, deg/m, and its wheels do not notice.
[[nodiscard]] Pose3 pulled_aside(const Pose3& motion, double deg_per_m, Rng& rng);
using PulledAside = Odometry<pulled_aside>;

/// In this share of the samples the wheels spin: way and turn are measured up to twice as large.
[[nodiscard]] Pose3 spun(const Pose3& motion, double share, Rng& rng);
using SpinningWheels = Odometry<spun>;

/// In this share of the samples the wheels count backwards.
[[nodiscard]] Pose3 reversed(const Pose3& motion, double share, Rng& rng);
using ReversedMotions = Odometry<reversed>;

/// In this share of the samples no motion is measured.
[[nodiscard]] Pose3 lost(const Pose3& motion, double share, Rng& rng);
using LostMotions = Odometry<lost>;

}  // namespace glocal::disturbed
