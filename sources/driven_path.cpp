#include "sources/driven_path.hpp"

#include <algorithm>
#include <utility>

#include "glocal/error.hpp"

namespace glocal {
namespace {

bool are_rising(const PathSegments& segments) {
  double last = 0.0;
  for (const auto& [from, to] : segments) {
    if (!(from >= last && to > from)) return false;
    last = to;
  }
  return true;
}

std::string share_text(double share) {
  std::string text = std::to_string(share);
  text.erase(std::max(text.find_last_not_of('0') + 1, text.find('.') + 2));
  return text;
}

}  // namespace

void describe_segments(ParamVisitor& v, PathSegments& segments) {
  v.field("segments", segments,
          {.doc = "Parts of the drive to use, as [from, to] shares of the driven path.",
           .min = 0.0,
           .max = 1.0,
           .min_items = 1});
}

void require_rising(ParamVisitor& v, const PathSegments& segments) {
  v.require(are_rising(segments), "segments",
            "each must be [from, to] with from < to, in rising order and without overlap");
}

std::vector<std::vector<std::size_t>> places_on(const PathSegments& segments,
                                                const std::vector<double>& lengths, const std::string& file,
                                                const std::string& what) {
  std::vector<std::vector<std::size_t>> places;
  std::vector<Fault> faults;
  const double total = lengths.back();
  for (const auto& [from, to] : segments) {
    std::vector<std::size_t>& inside = places.emplace_back();
    for (std::size_t i = 0; i < lengths.size(); ++i) {
      if (lengths[i] >= from * total && (lengths[i] < to * total || to >= 1.0)) inside.push_back(i);
    }
    if (!inside.empty()) continue;
    faults.push_back({file, 0, 0,
                      "has no " + what + " between " + share_text(from) + " and " + share_text(to) +
                          " of its path; widen the segment"});
  }
  if (!faults.empty()) throw ConfigError(std::move(faults));
  return places;
}

void describe_keyframes(ParamVisitor& v, KeyframeRule& rule) {
  v.field("keyframe_distance", rule.distance,
          {.doc = "A scan is used once odometry has moved this far since the last one used, or turned by "
                  "keyframe_angle_deg; 0 uses every scan.",
           .unit = "m",
           .min = 0.0,
           .audience = Audience::tuner});
  v.field("keyframe_angle_deg", rule.angle_deg,
          {.doc = "A scan is used once odometry has turned this much since the last one used, or moved by "
                  "keyframe_distance; 0 uses every scan.",
           .unit = "deg",
           .min = 0.0,
           .formerly = "keyframe_angle"});
}

bool is_keyframe(const Pose3& last, const Pose3& now, const KeyframeRule& rule) {
  return distance(last, now) >= rule.distance || rotation_between(last, now) >= radians(rule.angle_deg);
}

std::vector<Pose3> sparse_path(const std::vector<Pose3>& path) {
  constexpr double spacing = 0.25;  // m
  std::vector<Pose3> sparse;
  for (const Pose3& pose : path) {
    if (sparse.empty() || distance(sparse.back(), pose) >= spacing) sparse.push_back(pose);
  }
  return sparse;
}

}  // namespace glocal
