#include "sources/several/several_drives.hpp"

#include <utility>

#include "sources/several/one_of_several.hpp"

namespace glocal::several {

void describe(ParamVisitor& v, DriveOnMap& p) {
  v.field("map", p.map,
          {.doc = "Name of the map that its reference poses are on, as the map source says it.",
           .required = true});
  v.strategy("source", p.source, *p.sources, {.doc = "The drive.", .required = true});
}

void describe(ParamVisitor& v, SeveralDrives::Params& p) {
  v.field("drives", p.drives, {.doc = "One after the other.", .min_items = 1, .required = true},
          {.sources = p.sources});
  v.field("in_lift", p.in_lift,
          {.doc = "The robot goes from one drive to the next in a lift, and does not know it: time and "
                  "odometry go on, and trials run across. Otherwise each drive is one of its own."});
}

SeveralDrives::SeveralDrives(const Params& params, const SourceSetup& setup) : in_lift_(params.in_lift) {
  for (const DriveOnMap& drive : params.drives) {
    // Drives of one world are not the same drive again.
    const SourceSetup own = setup_of(drives_.size(), setup);
    drives_.push_back({drive.map, params.sources->make(drive.source, own)});
  }
}

std::optional<Sample> SeveralDrives::next() {
  for (; now_ < drives_.size(); ++now_, is_first_ = true) {
    std::optional<Sample> sample = drives_[now_].source->next();
    if (!sample) continue;
    const bool is_first_of_later = std::exchange(is_first_, false) && last_segment_ >= 0;
    if (is_first_of_later) follow_on(*sample);
    sample->segment += segments_;
    sample->observation.stamp += stamp_shift_;
    sample->observation.odom_from_robot = odom_from_odom_ * sample->observation.odom_from_robot;
    last_segment_ = sample->segment;
    last_stamp_ = sample->observation.stamp;
    last_odom_ = sample->observation.odom_from_robot;
    sample->map = drives_[now_].map;
    return sample;
  }
  return std::nullopt;
}

void SeveralDrives::follow_on(const Sample& first) {
  constexpr double in_lift_s = 20.0;
  segments_ = last_segment_ + (in_lift_ ? 0 : 1) - first.segment;
  if (!in_lift_) return;
  const Pose3& odom_from_robot = first.observation.odom_from_robot;
  stamp_shift_ = last_stamp_ + in_lift_s - first.observation.stamp;
  // Only turned about z: what is up stays up.
  odom_from_odom_ = seen_from_above(last_odom_) * inverse(seen_from_above(odom_from_robot));
  odom_from_odom_.z = last_odom_.z - odom_from_robot.z;
}

}  // namespace glocal::several
