// glocal map align: where one map lies in another.
#include "app/map_align.hpp"

#include <optional>

#include "glocal/contact.hpp"
#include "glocal/distance_field.hpp"

namespace glocal::app {

std::optional<Alignment> align_maps(const GlobalMap& map, const Points& other, Matcher& matcher,
                                    double contact_epsilon, std::uint64_t seed) {
  LocalMap local;
  local.points = other;
  local.ends = {other.size()};
  Rng rng(seed);
  // Maps of one place may have little in common: furniture, rooms behind doors.
  for (const double omega_max : {0.6, 0.4, 0.25}) {
    const MatchResult result = matcher.match({local, {}, omega_max}, rng);
    if (result.hypotheses.empty()) continue;
    // About the middle of the points, so that turning them does not move them.
    const Vector3 middle = centroid(other);
    const Pose2 other_from_middle{middle.x(), middle.y(), 0.0};
    Points centred;
    const Transform to_middle(inverse(other_from_middle));
    for (std::size_t i = 0; i < other.size(); ++i) centred.push_back(to_middle(other[i]));
    const Pose2 map_from_middle = refined_pose(
        DistanceField(map.points()), centred,
        seen_from_above(result.hypotheses.front().map_from_local) * other_from_middle, {.iterations = 100});
    const Pose2 map_from_other = map_from_middle * inverse(other_from_middle);
    const auto contact = contact_index(map, "bitset", contact_epsilon);
    return Alignment{map_from_other, contact->share(other, Transform(map_from_other))};
  }
  return std::nullopt;
}

}  // namespace glocal::app
