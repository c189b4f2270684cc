#include "local_mappers/range_profile.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace glocal::local_mappers {
namespace {

/// Directions around a sensor, a degree each, as the beams of common lasers.
constexpr std::size_t directions = 360;

std::size_t direction(float x, float y) {
  constexpr auto per_radian = static_cast<float>(directions / (2.0 * std::numbers::pi));
  return static_cast<std::size_t>(std::atan2(y, x) * per_radian + static_cast<float>(directions)) %
         directions;
}

}  // namespace

RangeProfile::RangeProfile(const Scan& scan) : origin_(scan.origin), ranges_(directions, 0.0F) {
  for (const Points* ends : {&scan.hits, &scan.free_ends}) {
    for (std::size_t i = 0; i < ends->size(); ++i) {
      const float x = ends->x[i] - origin_.x;
      const float y = ends->y[i] - origin_.y;
      const float range = std::hypot(x, y);
      float& nearest = ranges_[direction(x, y)];
      nearest = nearest == 0.0F ? range : std::min(nearest, range);
    }
  }
  // Beams a degree apart may leave a direction empty by rounding.
  const std::vector<float> given = ranges_;
  for (std::size_t d = 0; d < directions; ++d) {
    const float before = given[(d + directions - 1) % directions];
    const float after = given[(d + 1) % directions];
    if (given[d] == 0.0F) ranges_[d] = std::min(before, after);
  }
}

float RangeProfile::range_towards(const Point& p) const {
  return ranges_[direction(p.x - origin_.x, p.y - origin_.y)];
}

RangeProfile::View RangeProfile::view_of(const Point& p) const {
  const float x = p.x - origin_.x;
  const float y = p.y - origin_.y;
  const std::size_t d = direction(x, y);
  // Neighbours have their say, too: at the edge of a thing the beam may go past it, or not.
  const std::array around{ranges_[(d + directions - 1) % directions], ranges_[d],
                          ranges_[(d + 1) % directions]};
  const auto [nearest, farthest] = std::minmax_element(around.begin(), around.end());
  const float range = std::hypot(x, y);
  if (*nearest == 0.0F || range > *farthest + margin) return View::none;
  return range < *nearest - margin ? View::passed : View::met;
}

RangeProfile::Seen RangeProfile::look_at(const Points& hits, const Pose2& here_from_hits) const {
  const Transform transform(here_from_hits);
  Seen seen;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const View view = view_of(transform(hits[i]));
    if (view != View::none) ++(view == View::passed ? seen.violation : seen.met);
  }
  return seen;
}

}  // namespace glocal::local_mappers
