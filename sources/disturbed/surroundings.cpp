#include "sources/disturbed/surroundings.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

namespace glocal::disturbed {
namespace {

constexpr double panel = 1.0;           // m, side of a pane of glass, or of a mirror
constexpr float least_behind = 0.5F;    // m
constexpr float most_behind = 3.0F;     // m
constexpr double nothing_behind = 0.3;  // share of panes

constexpr double wall_nearby = 0.3;  // m about a hit, where a wall is straight
constexpr int least_of_wall = 3;     // hits
constexpr double ray_radius = 0.1;   // m, within which a hit is on a ray

constexpr double reach = 8.0;       // m from the robot
constexpr double radius = 0.25;     // m of a person
constexpr double height = 1.75;     // m of a person, above the robot's frame
constexpr double stride = 0.4;      // m from scan to scan
constexpr double most_turn = 0.5;   // rad from scan to scan
constexpr double elbow_room = 0.5;  // m between sensor and person

std::uint64_t cell_of(double coordinate) {
  return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(coordinate / panel)));
}

/// Where the wall runs at a hit, rad, seen from above: the long axis of the hits of its ring about it.
std::optional<double> wall_direction(const Readings& readings, const Reading& hit) {
  double xx = 0.0, xy = 0.0, yy = 0.0;
  int number = 0;
  for (const Reading& other : readings.all()) {
    const double x = other.end.x - hit.end.x, y = other.end.y - hit.end.y;
    if (!other.is_hit || std::hypot(x, y) > wall_nearby || readings.ring(other) != readings.ring(hit))
      continue;
    xx += x * x;
    xy += x * y;
    yy += y * y;
    ++number;
  }
  if (number < least_of_wall) return std::nullopt;
  return 0.5 * std::atan2(2.0 * xy, xx - yy);
}

/// Distance (m) along a ray of unit direction to the first hit on it, behind the wall that it leaves.
std::optional<double> distance_to_hit(const Readings& readings, const Vector3& from,
                                      const Vector3& direction) {
  std::optional<double> nearest;
  for (const Reading& other : readings.all()) {
    if (!other.is_hit) continue;
    const Vector3 to_hit = as_vector(other.end) - from;
    const double along = to_hit.dot(direction);
    if (along < wall_nearby || (nearest && along >= *nearest)) continue;
    if ((to_hit - direction * along).norm() <= ray_radius) nearest = along;
  }
  return nearest;
}

/// Distance (m) along a ray of unit direction to a person who stands at `at`, seen from where the ray begins;
/// infinite if it does not meet him.
double distance_along(const Pose2& direction, const Pose2& at) {
  const double along = direction.x * at.x + direction.y * at.y;
  const double beside = direction.x * at.y - direction.y * at.x;
  if (along <= 0.0 || std::abs(beside) >= radius) return std::numeric_limits<double>::infinity();
  return along - std::sqrt(radius * radius - beside * beside);
}

/// Whoever leaves the robot's surroundings comes back from the other side.
void walk(Pose2& at, const Pose2& odom_from_robot, Rng& rng) {
  at.theta = wrap_angle(at.theta + rng.uniform(-most_turn, most_turn));
  at = at * Pose2{stride, 0.0, 0.0};
  const double away = std::hypot(at.x - odom_from_robot.x, at.y - odom_from_robot.y);
  if (away <= reach) return;
  at.x = odom_from_robot.x - (at.x - odom_from_robot.x) * reach / away;
  at.y = odom_from_robot.y - (at.y - odom_from_robot.y) * reach / away;
}

}  // namespace

std::optional<Sample> Panes::disturb(Sample sample, Rng /*rng*/) {
  Readings before(sample.observation.scan);
  Readings readings = before;
  const Pose3& odom_from_robot = sample.observation.odom_from_robot;
  for (Reading& reading : readings.all()) {
    if (!reading.is_hit) continue;
    const Vector3 place = odom_from_robot * as_vector(reading.end);
    Rng of_pane = rng_.stream({cell_of(place.x()), cell_of(place.y())});
    if (of_pane.uniform() < share_) change(reading, before, of_pane);
  }
  sample.observation.scan = readings.scan();
  return sample;
}

void Glass::change(Reading& reading, const Readings& before, Rng of_pane) const {
  reading.is_hit = of_pane.uniform() >= nothing_behind;
  before.set_range(reading, reading.range + static_cast<float>(of_pane.uniform(least_behind, most_behind)));
}

void Mirrors::change(Reading& reading, const Readings& before, Rng /*of_pane*/) const {
  const std::optional<double> wall = wall_direction(before, reading);
  if (!wall) return;
  const Vector3 ray = (as_vector(reading.end) - as_vector(before.origin())) / reading.range;
  const double bearing = 2.0 * *wall - std::atan2(ray.y(), ray.x());
  const double across = std::hypot(ray.x(), ray.y());
  const Vector3 mirrored{across * std::cos(bearing), across * std::sin(bearing), ray.z()};
  const std::optional<double> beyond = distance_to_hit(before, as_vector(reading.end), mirrored);
  reading.is_hit = beyond.has_value();
  before.set_range(reading, beyond ? reading.range + static_cast<float>(*beyond) : before.farthest());
}

People::People(double people, Rng /*rng*/)
    : odom_from_people_(static_cast<std::size_t>(std::lround(people))) {}

std::optional<Sample> People::disturb(Sample sample, Rng rng) {
  const Pose2 odom_from_robot = seen_from_above(sample.observation.odom_from_robot);
  for (Pose2& odom_from_person : odom_from_people_) {
    if (are_placed_) {
      walk(odom_from_person, odom_from_robot, rng);
      continue;
    }
    const double bearing = rng.uniform(-std::numbers::pi, std::numbers::pi);
    const double away = reach * std::sqrt(rng.uniform());
    odom_from_person = odom_from_robot * Pose2{away * std::cos(bearing), away * std::sin(bearing),
                                               rng.uniform(-std::numbers::pi, std::numbers::pi)};
  }
  are_placed_ = true;
  Readings readings(sample.observation.scan);
  const Point& origin = readings.origin();
  for (const Pose2& odom_from_person : odom_from_people_) {
    const Pose2 in_robot = inverse(odom_from_robot) * odom_from_person;
    const Pose2 at{in_robot.x - origin.x, in_robot.y - origin.y, 0.0};
    if (std::hypot(at.x, at.y) < radius + elbow_room) continue;
    for (Reading& reading : readings.all()) {
      const double bearing = readings.bearing(reading);
      double away = distance_along({std::cos(bearing), std::sin(bearing), 0.0}, at);
      if (const double rise = reading.end.z - origin.z; rise != 0.0) {
        const double across = std::hypot(reading.end.x - origin.x, reading.end.y - origin.y);
        if (origin.z + rise * away / across > height) continue;
        away *= reading.range / across;
      }
      if (!(away < reading.range)) continue;
      readings.set_range(reading, static_cast<float>(away));
      reading.is_hit = true;
    }
  }
  sample.observation.scan = readings.scan();
  return sample;
}

}  // namespace glocal::disturbed
