#include "sources/disturbed/surroundings.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "sources/disturbed/readings.hpp"

namespace glocal::disturbed {
namespace {

constexpr double panel = 1.0;           // m, side of a pane of glass
constexpr float least_behind = 0.5F;    // m
constexpr float most_behind = 3.0F;     // m
constexpr double nothing_behind = 0.3;  // share of panes

constexpr double reach = 8.0;       // m from the robot
constexpr double radius = 0.25;     // m of a person
constexpr double stride = 0.4;      // m from scan to scan
constexpr double most_turn = 0.5;   // rad from scan to scan
constexpr double elbow_room = 0.5;  // m between sensor and person

std::uint64_t cell_of(double coordinate) {
  return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(coordinate / panel)));
}

/// Distance (m) along a ray of unit direction to a person who stands at `at`, seen from where the ray begins;
/// infinite if it does not meet him.
double distance_along(const Pose2& direction, const Pose2& at) {
  const double along = direction.x * at.x + direction.y * at.y;
  const double beside = direction.x * at.y - direction.y * at.x;
  if (along <= 0.0 || std::abs(beside) >= radius) return std::numeric_limits<double>::infinity();
  return along - std::sqrt(radius * radius - beside * beside);
}

}  // namespace

std::optional<Sample> Glass::disturb(Sample sample, Rng /*rng*/) {
  Readings readings(sample.observation.scan);
  const Pose3& odom_from_robot = sample.observation.odom_from_robot;
  for (Reading& reading : readings.all()) {
    if (!reading.is_hit) continue;
    const Vector3 place = odom_from_robot * as_vector(reading.end);
    Rng of_pane = rng_.stream({cell_of(place.x()), cell_of(place.y())});
    if (of_pane.uniform() >= share_) continue;
    reading.is_hit = of_pane.uniform() >= nothing_behind;
    readings.set_range(reading,
                       reading.range + static_cast<float>(of_pane.uniform(least_behind, most_behind)));
  }
  sample.observation.scan = readings.scan();
  return sample;
}

People::People(double people, Rng /*rng*/) : people_(static_cast<std::size_t>(std::lround(people))) {}

/// Whoever leaves the robot's surroundings comes back from the other side.
void People::walk(Person& person, const Pose2& odom_from_robot, Rng& rng) const {
  Pose2& at = person.odom_from_person;
  at.theta = wrap_angle(at.theta + rng.uniform(-most_turn, most_turn));
  at = at * Pose2{stride, 0.0, 0.0};
  const double away = std::hypot(at.x - odom_from_robot.x, at.y - odom_from_robot.y);
  if (away <= reach) return;
  at.x = odom_from_robot.x - (at.x - odom_from_robot.x) * reach / away;
  at.y = odom_from_robot.y - (at.y - odom_from_robot.y) * reach / away;
}

std::optional<Sample> People::disturb(Sample sample, Rng rng) {
  const Pose2 odom_from_robot = seen_from_above(sample.observation.odom_from_robot);
  for (Person& person : people_) {
    if (are_placed_) {
      walk(person, odom_from_robot, rng);
      continue;
    }
    const double bearing = rng.uniform(-std::numbers::pi, std::numbers::pi);
    const double away = reach * std::sqrt(rng.uniform());
    person.odom_from_person = odom_from_robot * Pose2{away * std::cos(bearing), away * std::sin(bearing),
                                                      rng.uniform(-std::numbers::pi, std::numbers::pi)};
  }
  are_placed_ = true;
  Readings readings(sample.observation.scan);
  const Point& origin = readings.origin();
  for (const Person& person : people_) {
    const Pose2 in_robot = inverse(odom_from_robot) * person.odom_from_person;
    const Pose2 at{in_robot.x - origin.x, in_robot.y - origin.y, 0.0};
    if (std::hypot(at.x, at.y) < radius + elbow_room) continue;
    for (Reading& reading : readings.all()) {
      const double bearing = readings.bearing(reading);
      const double away = distance_along({std::cos(bearing), std::sin(bearing), 0.0}, at);
      if (away >= reading.range) continue;
      readings.set_range(reading, static_cast<float>(away));
      reading.is_hit = true;
    }
  }
  sample.observation.scan = readings.scan();
  return sample;
}

}  // namespace glocal::disturbed
