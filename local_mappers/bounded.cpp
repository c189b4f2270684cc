#include "local_mappers/bounded.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "local_mappers/chosen_points.hpp"
#include "local_mappers/lone_hits.hpp"

namespace glocal::local_mappers {
namespace {

/// Scans that a new one looks at: older ones lie behind the robot, as a rule.
constexpr std::size_t scans_looked_at = 12;
/// Later scans that look through a hit, at least, before it is taken out.
constexpr std::uint8_t scans_to_be_gone = 2;

LocalScan chosen(const LocalScan& scan, const std::vector<bool>& stays) {
  LocalScan rest;
  rest.hits = chosen_points(scan.hits, stays);
  rest.normals = chosen_points(scan.normals, stays);
  return rest;
}

/// A scan without the hits that stand alone in it: in a map of many scans they would be more than all others.
LocalScan without_lone_hits(const LocalScan& scan, const Scan& as_measured) {
  if (scan.hits.empty()) return {};
  std::vector<bool> stays = lone_hits(as_measured.hits, as_measured.origin);
  stays.flip();
  return chosen(scan, stays);
}

}  // namespace

void describe(ParamVisitor& v, Bounded::Params& p) {
  v.field("scans", p.scans,
          {.doc = "The map is made of the last observations, so many of them; 0 sets no such limit.",
           .min = 0,
           .max = 1e6,
           .audience = Audience::tuner});
  v.field("distance", p.distance,
          {.doc = "The map is made of the observations of the last way of this length; 0 sets no such limit, "
                  "and then a robot that stands still fills the map unless scans is set.",
           .unit = "m",
           .min = 0.0});
  v.require(p.scans > 0 || p.distance > 0.0, "scans", "either scans or distance must be above 0");
  describe_common(v, p.matching);
}

void Bounded::reset() {
  matching_.reset();
  moving_along_.reset();
  window_.clear();
}

void Bounded::add(const Observation& observation) {
  std::vector<bool> is_of_place = moving_along_.update(observation);
  is_of_place.flip();
  const bool is_all_of_place = std::find(is_of_place.begin(), is_of_place.end(), false) == is_of_place.end();
  if (is_all_of_place) return add_place(observation);
  const Scan& scan = observation.scan;
  add_place({observation.stamp,
             {chosen_points(scan.hits, is_of_place), scan.free_ends, scan.origin},
             observation.odom_from_robot});
}

void Bounded::add_place(const Observation& observation) {
  const int epoch = map().epoch;
  const Pose2 last = matching_.robot();
  const LocalScan placed = matching_.place(observation);
  if (map().epoch != epoch) window_.clear();
  bool is_changed = !placed.hits.empty() && take_out_gone(matching_.profile());
  const double way = window_.empty() ? 0.0 : window_.back().way + distance(last, matching_.robot());
  LocalScan scan = without_lone_hits(placed, observation.scan);
  const std::size_t n = scan.hits.size();
  window_.push_back({std::move(scan), way, std::vector<std::uint8_t>(n, 0)});
  for (; is_too_long(); is_changed = true) window_.pop_front();
  if (!is_changed) return matching_.insert(window_.back().scan);
  matching_.clear();
  for (const Placed& before : window_) matching_.insert(before.scan);
}

bool Bounded::take_out_gone(const RangeProfile& now) {
  const Transform robot_from_local(inverse(matching_.robot()));
  const std::size_t looked_at = std::min(window_.size(), scans_looked_at);
  bool is_any = false;
  for (auto before = window_.end() - static_cast<std::ptrdiff_t>(looked_at); before != window_.end();
       ++before) {
    std::vector<bool> stays(before->gone.size(), true);
    for (std::size_t i = 0; i < stays.size(); ++i) {
      const RangeProfile::View view = now.view_of(robot_from_local(before->scan.hits[i]));
      std::uint8_t& gone = before->gone[i];
      if (view == RangeProfile::View::passed) ++gone;
      if (view == RangeProfile::View::met && gone > 0) --gone;
      stays[i] = gone < scans_to_be_gone;
    }
    if (std::find(stays.begin(), stays.end(), false) == stays.end()) continue;
    before->scan = chosen(before->scan, stays);
    std::erase(before->gone, scans_to_be_gone);
    is_any = true;
  }
  return is_any;
}

bool Bounded::is_too_long() const {
  const bool too_many = params_.scans > 0 && window_.size() > static_cast<std::size_t>(params_.scans);
  const double way = window_.back().way - window_.front().way;
  return too_many || (params_.distance > 0.0 && way > params_.distance);
}

}  // namespace glocal::local_mappers
