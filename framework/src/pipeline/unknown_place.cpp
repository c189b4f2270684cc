#include "glocal/unknown_place.hpp"

#include <cmath>
#include <utility>

#include "glocal/clearance_grid.hpp"
#include "glocal/voxel_numbers.hpp"

namespace glocal {
namespace {

/// The last part of a beam before its hit, where a wall of the map may well be, m.
constexpr double blur = 0.3;

/// One hit of each voxel: what is near, as a person beside the robot, has most of a scan's hits, and is not
/// most of what it sees.
Points thinned(const Points& hits, double side) {
  VoxelNumbers<std::int64_t> voxels(hits.size());
  const auto index = [&](float along) { return static_cast<std::int64_t>(std::floor(along / side)); };
  Points chosen;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const Point& hit = hits[i];
    if (voxels.find_or_add({index(hit.x), index(hit.y), index(hit.z)}) == chosen.size())
      chosen.push_back(hit);
  }
  return chosen;
}

}  // namespace

void describe(ParamVisitor& v, UnknownPlaceParams& p) {
  v.field(
      "window", p.window,
      {.doc = "Number of scans that are averaged (tau' in eq. 10).", .min = 1, .audience = Audience::expert});
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
      epsilon_(params.contact_epsilon.value_or(contact_epsilon)),
      contact_(contact_index(*map_, "bitset", epsilon_)) {}

std::optional<double> UnknownPlaceMonitor::update(const LocalMap& local, const Points& hits,
                                                  const std::vector<Hypothesis>& hypotheses) {
  if (local.epoch != epoch_) reset();
  epoch_ = local.epoch;
  if (!hits.empty()) scans_.push_back(moved(thinned(hits, epsilon_), local.local_from_robot));
  if (scans_.size() > static_cast<std::size_t>(params_.window)) scans_.pop_front();
  if (!hypotheses.empty()) best_ = hypotheses.front().map_from_local;
  if (!best_ || scans_.empty()) return std::nullopt;
  double sum_of_shares = 0.0;
  for (const Points& scan : scans_) sum_of_shares += contact_->share(scan, *best_);
  return sum_of_shares / static_cast<double>(scans_.size());
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
