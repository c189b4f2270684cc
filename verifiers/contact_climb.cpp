#include "verifiers/contact_climb.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "glocal/extent.hpp"

namespace glocal::verifiers {
namespace {

/// Of the farthest point from the middle, seen from above, m; not so small that a step would be half a turn.
double radius_about(const Vector3& middle, const Points& points) {
  double radius = 0.5;
  for (std::size_t i = 0; i < points.size(); ++i)
    radius = std::max(radius, std::hypot(points.x[i] - middle.x(), points.y[i] - middle.y()));
  return radius;
}

/// A pose of the middle of the points, and its share of points in contact.
struct Climber {
  Pose3 map_from_middle;
  double contact = 0.0;
};

}  // namespace

Pose3 climbed_pose(const ContactIndex& contact, const Points& points, const Pose3& map_from_points,
                   double step) {
  constexpr int halvings = 2;
  const Pose3 points_from_middle(Vector3{extent_of(points.x).middle(), extent_of(points.y).middle(), 0.0});
  const Pose3 middle_from_points = inverse(points_from_middle);
  const double radius = radius_about(points_from_middle.translation(), points);
  const auto at = [&](const Pose3& map_from_middle) {
    return Climber{map_from_middle, contact.share(points, map_from_middle * middle_from_points)};
  };
  Climber best = at(map_from_points * points_from_middle);
  for (int i = 0; i <= halvings; ++i, step /= 2.0) {
    for (bool goes_on = true; goes_on;) {
      goes_on = false;
      const Pose3 from = best.map_from_middle;
      for (const double way : {step, -step}) {
        const std::array<Pose3, 4> moves{Pose3(Vector3{way, 0.0, 0.0}), Pose3(Vector3{0.0, way, 0.0}),
                                         Pose3(Vector3{0.0, 0.0, way}), Pose3(turn_about_z(way / radius))};
        for (const Pose3& move : moves) {
          const Climber neighbour = at(from * move);
          if (neighbour.contact <= best.contact) continue;
          best = neighbour;
          goes_on = true;
        }
      }
    }
  }
  return best.map_from_middle * middle_from_points;
}

}  // namespace glocal::verifiers
