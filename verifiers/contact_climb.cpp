#include "verifiers/contact_climb.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "glocal/extent.hpp"

namespace glocal::verifiers {
namespace {

/// Of the farthest point from the middle, m, seen from above where poses are upright; not so small that a
/// step would be half a turn.
double radius_about(const Vector3& middle, const Points& points, Motion motion) {
  double radius = 0.5;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double height = motion == Motion::free ? points.z[i] - middle.z() : 0.0;
    radius = std::max(radius, std::hypot(points.x[i] - middle.x(), points.y[i] - middle.y(), height));
  }
  return radius;
}

/// By a step along an axis, or a turn that moves a point at the radius by as much.
std::vector<Pose3> moves_by(double step, double radius, Motion motion) {
  std::vector<Pose3> moves{Pose3(Vector3{step, 0.0, 0.0}), Pose3(Vector3{0.0, step, 0.0}),
                           Pose3(Vector3{0.0, 0.0, step}), Pose3(turn_about_z(step / radius))};
  if (motion == Motion::free) {
    moves.emplace_back(exponential({step / radius, 0.0, 0.0}));
    moves.emplace_back(exponential({0.0, step / radius, 0.0}));
  }
  return moves;
}

/// A pose of the middle of the points, and its share of points in contact.
struct Climber {
  Pose3 map_from_middle;
  double contact = 0.0;
};

}  // namespace

Pose3 climbed_pose(const ContactIndex& contact, const Points& points, const Pose3& map_from_points,
                   double step, Motion motion) {
  constexpr int halvings = 2;
  const double height = motion == Motion::free ? extent_of(points.z).middle() : 0.0;
  const Pose3 points_from_middle(Vector3{extent_of(points.x).middle(), extent_of(points.y).middle(), height});
  const Pose3 middle_from_points = inverse(points_from_middle);
  const double radius = radius_about(points_from_middle.translation(), points, motion);
  const auto at = [&](const Pose3& map_from_middle) {
    return Climber{map_from_middle, contact.share(points, map_from_middle * middle_from_points)};
  };
  Climber best = at(map_from_points * points_from_middle);
  for (int i = 0; i <= halvings; ++i, step /= 2.0) {
    for (bool goes_on = true; goes_on;) {
      goes_on = false;
      const Pose3 from = best.map_from_middle;
      for (const double way : {step, -step}) {
        for (const Pose3& move : moves_by(way, radius, motion)) {
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
