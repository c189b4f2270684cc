#include "glocal/unknown_place.hpp"

#include <utility>

#include "glocal/clearance_grid.hpp"

namespace glocal {
namespace {

/// The last part of a beam before its hit, where a wall of the map may well be, m.
constexpr double blur = 0.3;

}  // namespace

void describe(ParamVisitor& v, UnknownPlaceParams& p) {
  v.field("window", p.window,
          {.doc = "Number of observations that are averaged (tau' in eq. 10).",
           .min = 1,
           .audience = Audience::expert});
  v.field("max_contact", p.max_contact,
          {.doc = "The verdict is unknown_place while Omega' (eq. 10) is below this; 0 switches it off.",
           .min = 0.0,
           .max = 1.0,
           .audience = Audience::tuner});
  describe_contact_epsilon(v, p.contact_epsilon);
}

UnknownPlaceMonitor::UnknownPlaceMonitor(const UnknownPlaceParams& params,
                                         std::shared_ptr<const GlobalMap> map, double contact_epsilon)
    : params_(params),
      map_(std::move(map)),
      contact_(contact_index(*map_, "bitset", params.contact_epsilon.value_or(contact_epsilon))) {}

std::optional<double> UnknownPlaceMonitor::update(const LocalMap& local,
                                                  const std::vector<Hypothesis>& hypotheses) {
  if (!hypotheses.empty()) best_ = Best{hypotheses.front().map_from_local, local.epoch};
  if (!best_ || best_->epoch != local.epoch) return std::nullopt;

  // Contact indexes move points in the plane only: others are moved before.
  const Pose3& pose = best_->map_from_local;
  const bool is_planar = pose.is_planar();
  const Points in_map = is_planar ? Points{} : moved(local.points, pose);
  const Points& points = is_planar ? local.points : in_map;
  const Transform map_from_points(is_planar ? seen_from_above(pose) : Pose2{});
  double sum_of_shares = 0.0;
  int observations = 0;
  for (std::size_t k = local.ends.size(); k > 0 && observations < params_.window; --k) {
    const std::size_t end = local.ends[k - 1];
    const std::size_t begin = k > 1 ? local.ends[k - 2] : 0;
    if (begin == end) continue;
    const std::size_t in_contact = contact_->count(points, begin, end - begin, map_from_points);
    sum_of_shares += static_cast<double>(in_contact) / static_cast<double>(end - begin);
    ++observations;
  }
  return observations == 0 ? std::nullopt : std::optional(sum_of_shares / observations);
}

std::vector<HitKind> UnknownPlaceMonitor::kinds_of(const Scan& scan, const Pose2& map_from_robot) const {
  const Transform transform(map_from_robot);
  const CellsUnder cell_under(map_->grid(), map_from_robot);
  const Point sensor = transform(scan.origin);
  // Made by the first who asks, as many localizers never do: those in space.
  const auto clearance = clearance_grid(*map_);
  const auto kind_of = [&](std::size_t i) {
    if (cell_under(scan.hits[i]) == Cell::unknown) return HitKind::unknown;
    if (contact_->count(scan.hits, i, 1, transform) > 0) return HitKind::on_map;
    return clearance->is_blocked(sensor, transform(scan.hits[i]), blur) ? HitKind::beyond : HitKind::unmapped;
  };
  std::vector<HitKind> kinds;
  kinds.reserve(scan.hits.size());
  for (std::size_t i = 0; i < scan.hits.size(); ++i) kinds.push_back(kind_of(i));
  return kinds;
}

}  // namespace glocal
