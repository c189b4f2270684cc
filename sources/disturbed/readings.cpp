#include "sources/disturbed/readings.hpp"

#include <algorithm>
#include <cmath>

#include "glocal/pose2.hpp"

namespace glocal::disturbed {
namespace {

float distance_between(const Point& a, const Point& b) {
  return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
}

}  // namespace

Readings::Readings(const Scan& scan) : origin_(scan.origin), has_times_(!scan.times.empty()) {
  readings_.reserve(scan.hits.size() + scan.free_ends.size());
  for (std::size_t i = 0; i < scan.hits.size(); ++i) {
    const Point end = scan.hits[i];
    readings_.push_back({end, distance_between(origin_, end), true, has_times_ ? scan.times[i] : 0.0F});
  }
  for (std::size_t i = 0; i < scan.free_ends.size(); ++i) {
    const Point end = scan.free_ends[i];
    readings_.push_back({end, distance_between(origin_, end), false});
  }
}

float Readings::farthest() const {
  float most = 0.0F;
  for (const Reading& reading : readings_) most = std::max(most, reading.range);
  return most;
}

float Readings::bearing(const Reading& reading) const {
  return std::atan2(reading.end.y - origin_.y, reading.end.x - origin_.x);
}

int Readings::ring(const Reading& reading) const {
  const float across = std::hypot(reading.end.x - origin_.x, reading.end.y - origin_.y);
  return static_cast<int>(std::lround(degrees(std::atan2(reading.end.z - origin_.z, across))));
}

void Readings::set_range(Reading& reading, float range) const {
  if (reading.range <= 0.0F) return;
  const float factor = std::max(range, 0.0F) / reading.range;
  reading.end = origin_ + factor * (reading.end - origin_);
  reading.range = std::max(range, 0.0F);
}

Scan Readings::scan() const {
  Scan scan;
  scan.origin = origin_;
  for (const Reading& reading : readings_) {
    (reading.is_hit ? scan.hits : scan.free_ends).push_back(reading.end);
    if (reading.is_hit && has_times_) scan.times.push_back(reading.time);
  }
  return scan;
}

}  // namespace glocal::disturbed
