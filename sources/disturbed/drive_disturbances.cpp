#include "sources/disturbed/drive_disturbances.hpp"

#include <cmath>
#include <utility>

#include "sources/disturbed/readings.hpp"

namespace glocal::disturbed {
namespace {

std::size_t whole(double amount) {
  return static_cast<std::size_t>(std::lround(amount));
}

}  // namespace

std::optional<Sample> drop(Sample sample, double share, Rng& rng) {
  if (rng.uniform() < share) return std::nullopt;
  return sample;
}

LateScans::LateScans(double samples, Rng /*rng*/) : samples_(whole(samples)) {}

std::optional<Sample> LateScans::disturb(Sample sample, Rng /*rng*/) {
  if (begins_segment(sample)) on_the_way_.clear();
  on_the_way_.push_back(std::move(sample.observation.scan));
  if (on_the_way_.size() <= samples_) return std::nullopt;
  sample.observation.scan = std::move(on_the_way_.front());
  on_the_way_.pop_front();
  return sample;
}

RepeatedScans::RepeatedScans(double samples, Rng /*rng*/) : samples_(whole(samples)) {}

std::optional<Sample> RepeatedScans::disturb(Sample sample, Rng /*rng*/) {
  if (begins_segment(sample)) left_ = 0;
  if (left_ == 0) {
    scan_ = std::move(sample.observation.scan);
    left_ = samples_;
  }
  --left_;
  sample.observation.scan = scan_;
  return sample;
}

std::optional<Sample> turn_mount(Sample sample, double angle_deg, Rng& /*rng*/) {
  Scan& scan = sample.observation.scan;
  // What the sensor sees ahead lies to its left: it is put to the right.
  const Transform turn(Pose2{0.0, 0.0, -radians(angle_deg)});
  const auto turned = [&](const Point& p) {
    const Point q = turn({p.x - scan.origin.x, p.y - scan.origin.y, p.z});
    return Point{q.x + scan.origin.x, q.y + scan.origin.y, q.z};
  };
  for (Points* points : {&scan.hits, &scan.free_ends}) {
    for (std::size_t i = 0; i < points->size(); ++i) points->set(i, turned((*points)[i]));
  }
  return sample;
}

std::optional<Sample> turn_over(Sample sample, double /*amount*/, Rng& /*rng*/) {
  Scan& scan = sample.observation.scan;
  for (Points* points : {&scan.hits, &scan.free_ends}) {
    for (float& y : points->y) y = 2.0F * scan.origin.y - y;
    for (float& z : points->z) z = 2.0F * scan.origin.z - z;
  }
  return sample;
}

std::optional<Sample> mirror(Sample sample, double /*amount*/, Rng& /*rng*/) {
  Observation& observation = sample.observation;
  observation.scan.origin.y = -observation.scan.origin.y;
  for (Points* points : {&observation.scan.hits, &observation.scan.free_ends}) {
    for (float& y : points->y) y = -y;
  }
  // A mirror at the plane y = 0 turns x and z the other way round.
  const Pose3& robot = observation.odom_from_robot;
  const Quaternion& q = robot.rotation;
  observation.odom_from_robot = {{robot.x, -robot.y, robot.z}, {q.w(), -q.x(), q.y(), -q.z()}};
  return sample;
}

std::optional<Sample> StuckRanges::disturb(Sample sample, Rng /*rng*/) {
  Readings readings(sample.observation.scan);
  for (Reading& reading : readings.all()) {
    const auto bearing = static_cast<std::int64_t>(std::floor(degrees(readings.bearing(reading))));
    const Direction direction{bearing, readings.ring(reading)};
    Rng of_direction = rng_.stream(
        {static_cast<std::uint64_t>(bearing + 180), static_cast<std::uint64_t>(direction.second + 90)});
    if (of_direction.uniform() >= share_) continue;
    readings.set_range(reading, first_range_.try_emplace(direction, reading.range).first->second);
    reading.is_hit = true;
  }
  sample.observation.scan = readings.scan();
  return sample;
}

std::optional<Sample> Jitter::disturb(Sample sample, Rng rng) {
  if (begins_segment(sample)) last_.reset();
  Pose3& odom_from_robot = sample.observation.odom_from_robot;
  const Pose3 as_it_was = odom_from_robot;
  if (last_) {
    const Pose3 motion = inverse(*last_) * as_it_was;
    const double share = 1.0 - most_ * rng.uniform();
    odom_from_robot =
        *last_ * Pose3{share * motion.translation(), exponential(share * logarithm(motion.rotation))};
  }
  last_ = as_it_was;
  return sample;
}

Pose3 stretched(const Pose3& motion, double excess, Rng& /*rng*/) {
  return {(1.0 + excess) * motion.translation(), motion.rotation};
}

Pose3 pulled_aside(const Pose3& motion, double deg_per_m, Rng& /*rng*/) {
  const double turn = radians(deg_per_m) * motion.translation().norm();
  return {motion.translation(), composed(turn_about_z(-turn), motion.rotation)};
}

Pose3 spun(const Pose3& motion, double share, Rng& rng) {
  const bool spins = rng.uniform() < share;
  const double excess = rng.uniform();
  if (!spins) return motion;
  return {(1.0 + excess) * motion.translation(),
          composed(turn_about_z(excess * motion.heading()), motion.rotation)};
}

Pose3 reversed(const Pose3& motion, double share, Rng& rng) {
  return rng.uniform() < share ? inverse(motion) : motion;
}

Pose3 lost(const Pose3& motion, double share, Rng& rng) {
  return rng.uniform() < share ? Pose3{} : motion;
}

}  // namespace glocal::disturbed
