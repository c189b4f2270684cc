#include "local_mappers/moving_along.hpp"

#include <cmath>
#include <cstddef>

#include "local_mappers/chosen_points.hpp"

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
enum class Told { nothing, stands, moves_along };

Told told_of(const Point& hit, const Scan& scan, const RangeProfile& before, const Transform& before_from_now,
             float way) {
  const Point if_it_stands = before_from_now(hit);
  const float seen_along = before.range_towards(hit);
  const float seen_standing = before.range_towards(if_it_stands);
  if (seen_along == 0.0F || seen_standing == 0.0F) return Told::nothing;
  const float along = std::abs(range_of(hit, scan.origin) - seen_along) / way;
  const float standing = std::abs(range_of(if_it_stands, scan.origin) - seen_standing) / way;
  if (along < most_of_way && standing > least_of_way) return Told::moves_along;
  return standing < most_of_way && along > least_of_way ? Told::stands : Told::nothing;
}

/// Whether far hits stand, as odometry says. If its wheels spin, all moves along with the robot.
bool is_odometry_right(const Scan& scan, const std::vector<Told>& told) {
  std::size_t stand = 0, move = 0;
  for (std::size_t i = 0; i < told.size(); ++i) {
    if (range_of(scan.hits[i], scan.origin) < near) continue;
    if (told[i] == Told::stands) ++stand;
    if (told[i] == Told::moves_along) ++move;
  }
  return stand > 2 * move;
}

/// All hits of near things of which most move along.
std::vector<bool> of_whole_things(const Scan& scan, const std::vector<Told>& told) {
  const Points& hits = scan.hits;
  std::vector<bool> moving(hits.size(), false);
  for (std::size_t begin = 0, end = 0; begin < hits.size(); begin = end) {
    std::size_t move = 0;
    bool is_near = true;
    do {
      is_near = is_near && range_of(hits[end], scan.origin) < near;
      if (told[end] == Told::moves_along) ++move;
      ++end;
    } while (end < hits.size() &&
             std::hypot(hits.x[end] - hits.x[end - 1], hits.y[end] - hits.y[end - 1]) <= gap);
    for (std::size_t i = begin; i < end; ++i) moving[i] = is_near && 2 * move > end - begin;
  }
  return moving;
}

/// Which hits move along with a robot that has driven since the scan before.
std::vector<bool> that_moved_along(const Scan& scan, const RangeProfile& before, const Pose2& before_from_now,
                                   double way) {
  const Transform transform(before_from_now);
  std::vector<Told> told;
  for (std::size_t i = 0; i < scan.hits.size(); ++i)
    told.push_back(told_of(scan.hits[i], scan, before, transform, static_cast<float>(way)));
  return is_odometry_right(scan, told) ? of_whole_things(scan, told) : std::vector<bool>(told.size(), false);
}

/// Which hits are where something moved along before.
std::vector<bool> that_are_still_there(const Scan& scan, const RangeProfile& moving_along) {
  std::vector<bool> are_there;
  for (std::size_t i = 0; i < scan.hits.size(); ++i) {
    const float before = moving_along.range_towards(scan.hits[i]);
    // 0 where nothing is known.
    are_there.push_back(before > 0.0F && std::abs(range_of(scan.hits[i], scan.origin) - before) < as_before);
  }
  return are_there;
}

}  // namespace

std::vector<bool> MovingAlong::update(const Observation& observation) {
  const Scan& scan = observation.scan;
  const Pose2 odom_from_robot = seen_from_above(observation.odom_from_robot);
  std::vector<bool> moving(scan.hits.size(), false);
  if (before_) {
    const Pose2 before_from_now = inverse(before_->odom_from_robot) * odom_from_robot;
    const double way = std::hypot(before_from_now.x, before_from_now.y);
    moving = way < least_way ? that_are_still_there(scan, before_->moving_along)
                             : that_moved_along(scan, before_->all, before_from_now, way);
  }
  before_ = {
      odom_from_robot, RangeProfile(scan),
      RangeProfile({.hits = chosen_points(scan.hits, moving), .free_ends = {}, .origin = scan.origin})};
  return moving;
}

}  // namespace glocal::local_mappers
