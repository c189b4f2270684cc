#include "local_mappers/moving_along.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace glocal::local_mappers {
namespace {

/// Nobody walks along farther away, m. What is there tells whether odometry is right.
constexpr float near = 1.5F;
/// A robot that drives less shows nothing, m.
constexpr double least_way = 0.1;
/// What moves along stays where it is up to this share of the way, and what does not move differs from that
/// by this share.
constexpr float most_of_way = 0.3F;
constexpr float least_of_way = 0.5F;
/// Hits farther apart are of two things, m.
constexpr float gap = 0.3F;
/// What moved along before is still there, m.
constexpr float as_before = 0.1F;

float range_of(const Point& p, const Point& sensor) {
  return std::hypot(p.x - sensor.x, p.y - sensor.y);
}

/// What the scan before says of a hit.
enum class Motion { unknown, stands, moves_along };

Motion motion_of(const Point& hit, const Scan& scan, const RangeProfile& before,
                 const Transform& before_from_now, float way) {
  const Point if_it_stands = before_from_now(hit);
  const float seen_along = before.range_towards(hit);
  const float seen_standing = before.range_towards(if_it_stands);
  if (seen_along == 0.0F || seen_standing == 0.0F) return Motion::unknown;
  const float along = std::abs(range_of(hit, scan.origin) - seen_along) / way;
  const float standing = std::abs(range_of(if_it_stands, scan.origin) - seen_standing) / way;
  if (along < most_of_way && standing > least_of_way) return Motion::moves_along;
  return standing < most_of_way && along > least_of_way ? Motion::stands : Motion::unknown;
}

/// Whether far hits stand, as odometry says. If its wheels spin, all moves along with the robot.
bool is_odometry_right(const Scan& scan, const std::vector<Motion>& motions) {
  std::size_t stand = 0, move = 0;
  for (std::size_t i = 0; i < motions.size(); ++i) {
    if (range_of(scan.hits[i], scan.origin) < near) continue;
    if (motions[i] == Motion::stands) ++stand;
    if (motions[i] == Motion::moves_along) ++move;
  }
  return stand > 2 * move;
}

/// All hits of near things of which most move along.
std::vector<bool> of_whole_things(const Scan& scan, const std::vector<Motion>& motions) {
  const Points& hits = scan.hits;
  std::vector<bool> moving(hits.size(), false);
  for (std::size_t begin = 0, end = 0; begin < hits.size(); begin = end) {
    std::size_t move = 0;
    bool is_near = true;
    do {
      is_near = is_near && range_of(hits[end], scan.origin) < near;
      if (motions[end] == Motion::moves_along) ++move;
      ++end;
    } while (end < hits.size() &&
             std::hypot(hits.x[end] - hits.x[end - 1], hits.y[end] - hits.y[end - 1]) <= gap);
    for (std::size_t i = begin; i < end; ++i) moving[i] = is_near && 2 * move > end - begin;
  }
  return moving;
}

RangeProfile profile_of(const Scan& scan, const std::vector<bool>& chosen) {
  Scan some{.hits = {}, .free_ends = {}, .origin = scan.origin};
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (chosen[i]) some.hits.push_back(scan.hits[i]);
  }
  return RangeProfile(some);
}

}  // namespace

std::vector<bool> MovingAlong::update(const Observation& observation) {
  const Scan& scan = observation.scan;
  const Pose2 odom_from_robot = seen_from_above(observation.odom_from_robot);
  std::vector<bool> moving(scan.hits.size(), false);
  if (before_) {
    const Pose2 before_from_now = inverse(before_->odom_from_robot) * odom_from_robot;
    const double way = std::hypot(before_from_now.x, before_from_now.y);
    if (way < least_way) {
      for (std::size_t i = 0; i < moving.size(); ++i)
        moving[i] = std::abs(range_of(scan.hits[i], scan.origin) -
                             before_->moving_along.range_towards(scan.hits[i])) < as_before;
    } else {
      std::vector<Motion> motions(scan.hits.size());
      const Transform transform(before_from_now);
      for (std::size_t i = 0; i < motions.size(); ++i)
        motions[i] = motion_of(scan.hits[i], scan, before_->all, transform, static_cast<float>(way));
      if (is_odometry_right(scan, motions)) moving = of_whole_things(scan, motions);
    }
  }
  before_ = {odom_from_robot, RangeProfile(scan), profile_of(scan, moving)};
  return moving;
}

}  // namespace glocal::local_mappers
