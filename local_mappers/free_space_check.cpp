#include "local_mappers/free_space_check.hpp"

namespace glocal::local_mappers {

double FreeSpaceCheck::violation(const Scan& scan, const Pose2& local_from_robot) const {
  const RangeProfile now(scan);
  std::size_t through = 0;
  std::size_t all = 0;
  const auto count = [&](const RangeProfile::Seen& seen) {
    through += seen.violation;
    all += seen.violation + seen.met;
  };
  for (const PlacedScan& before : scans_) {
    const Pose2 before_from_now = inverse(before.local_from_robot) * local_from_robot;
    count(before.profile.look_at(scan.hits, before_from_now));
    count(now.look_at(before.hits, inverse(before_from_now)));
  }
  if (all < min_hits) return 0.0;
  return static_cast<double>(through) / static_cast<double>(all);
}

void FreeSpaceCheck::add(const Scan& scan, const Pose2& local_from_robot) {
  scans_.push_back({local_from_robot, scan.hits, RangeProfile(scan)});
  if (scans_.size() > scans) scans_.pop_front();
}

}  // namespace glocal::local_mappers
