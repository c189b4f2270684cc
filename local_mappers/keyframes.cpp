#include "local_mappers/keyframes.hpp"

#include <cmath>

namespace glocal::local_mappers {
namespace {

/// A hit lies on the map if a point of the map is at most this far away, m.
constexpr double overlap_distance = 0.1;

}  // namespace

void describe(ParamVisitor& v, Keyframes::Params& p) {
  v.field("distance", p.distance,
          {.doc = "An observation is a keyframe once the robot has moved this far since the last one.",
           .unit = "m",
           .min = 0.0,
           .audience = Audience::tuner});
  v.field("angle_deg", p.angle_deg,
          {.doc = "An observation is a keyframe once the robot has turned by this much since the last one.",
           .unit = "deg",
           .min = 0.0,
           .formerly = "angle"});
  v.field("overlap", p.overlap,
          {.doc = "An observation is a keyframe if less than this share of its hits lies on the map; 0 never "
                  "makes one for that.",
           .min = 0.0,
           .max = 1.0,
           .audience = Audience::expert});
  describe_common(v, p.matching);
}

void Keyframes::reset() {
  matching_.reset();
  local_from_last_.reset();
}

void Keyframes::add(const Observation& observation) {
  const int epoch = map().epoch;
  const LocalScan scan = matching_.place(observation);
  if (map().epoch != epoch) local_from_last_.reset();
  if (!is_keyframe(scan.hits)) {
    matching_.insert({});
    return;
  }
  local_from_last_ = matching_.robot();
  matching_.insert(scan);
}

bool Keyframes::is_keyframe(const Points& hits) const {
  if (hits.empty()) return false;
  if (!local_from_last_) return true;
  const Pose2& robot = matching_.robot();
  return distance(*local_from_last_, robot) >= params_.distance ||
         rotation_between(*local_from_last_, robot) >= radians(params_.angle_deg) ||
         overlap(hits) < params_.overlap;
}

double Keyframes::overlap(const Points& hits) const {
  std::size_t near = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const int found = matching_.grid().nearest(hits.x[i], hits.y[i]);
    if (found == PointGrid::none) continue;
    const Point p = map().points[static_cast<std::size_t>(found)];
    if (std::hypot(p.x - hits.x[i], p.y - hits.y[i]) <= overlap_distance) ++near;
  }
  return static_cast<double>(near) / static_cast<double>(hits.size());
}

}  // namespace glocal::local_mappers
