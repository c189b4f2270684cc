#include "local_mappers/bounded.hpp"

#include <cstddef>
#include <utility>
#include <vector>

#include "local_mappers/lone_hits.hpp"

namespace glocal::local_mappers {
namespace {

/// A scan without the hits that stand alone in it: in a map of many scans they would be more than all others.
LocalScan without_lone_hits(const LocalScan& scan, const Scan& as_measured) {
  if (scan.hits.empty()) return {};
  const std::vector<bool> is_lone = lone_hits(as_measured.hits, as_measured.origin);
  LocalScan rest;
  for (std::size_t i = 0; i < is_lone.size(); ++i) {
    if (is_lone[i]) continue;
    rest.hits.push_back(scan.hits[i]);
    rest.normals.push_back(scan.normals[i]);
  }
  return rest;
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
  describe(v, p.matching);
}

void Bounded::reset() {
  matching_.reset();
  window_.clear();
}

void Bounded::add(const Observation& observation) {
  const int epoch = map().epoch;
  const Pose2 last = matching_.robot();
  LocalScan scan = without_lone_hits(matching_.place(observation), observation.scan);
  if (map().epoch != epoch) window_.clear();
  const double way = window_.empty() ? 0.0 : window_.back().way + distance(last, matching_.robot());
  window_.push_back({std::move(scan), way});
  if (!is_too_long()) {
    matching_.insert(window_.back().scan);
    return;
  }
  while (is_too_long()) window_.pop_front();
  matching_.clear();
  for (const Placed& placed : window_) matching_.insert(placed.scan);
}

bool Bounded::is_too_long() const {
  const bool too_many = params_.scans > 0 && window_.size() > static_cast<std::size_t>(params_.scans);
  const double way = window_.back().way - window_.front().way;
  return too_many || (params_.distance > 0.0 && way > params_.distance);
}

}  // namespace glocal::local_mappers
