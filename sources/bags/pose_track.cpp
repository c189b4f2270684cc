#include "sources/bags/pose_track.hpp"

#include <algorithm>
#include <cstdlib>

namespace glocal::bags {

void PoseTrack::settle() {
  std::ranges::stable_sort(poses_, {}, &Poses::value_type::first);
  // Of equal stamps the last one: from the back, unique() keeps the first that it meets.
  const auto same_stamp = [](const auto& a, const auto& b) { return a.first == b.first; };
  poses_.erase(poses_.begin(), std::unique(poses_.rbegin(), poses_.rend(), same_stamp).base());
  is_still_ = !poses_.empty() && std::ranges::all_of(poses_, [&](const auto& stamped) {
    return stamped.second == poses_.front().second;
  });
}

void PoseTrack::forget_before(std::int64_t stamp_ns) {
  const auto after =
      std::upper_bound(poses_.begin(), poses_.end(), stamp_ns,
                       [](std::int64_t stamp, const auto& pose) { return stamp < pose.first; });
  if (after != poses_.begin()) poses_.erase(poses_.begin(), after - 1);
}

std::optional<Pose3> PoseTrack::at(std::int64_t stamp_ns, std::int64_t max_gap_ns) const {
  const auto after = not_before(stamp_ns);
  if (after == poses_.end()) return std::nullopt;
  if (after->first == stamp_ns) return after->second;
  if (after == poses_.begin()) return std::nullopt;
  const auto before = after - 1;
  if (after->first - before->first > max_gap_ns) return std::nullopt;
  const double share =
      static_cast<double>(stamp_ns - before->first) / static_cast<double>(after->first - before->first);
  return EvenMotion(before->second, after->second).at(share);
}

std::optional<Pose3> PoseTrack::nearest(std::int64_t stamp_ns, std::int64_t max_difference_ns) const {
  const auto after = not_before(stamp_ns);
  const auto difference = [&](auto pose) { return std::abs(pose->first - stamp_ns); };
  auto best = after;
  if (after != poses_.begin() && (after == poses_.end() || difference(after - 1) < difference(after)))
    best = after - 1;
  if (best == poses_.end() || difference(best) > max_difference_ns) return std::nullopt;
  return best->second;
}

PoseTrack::Poses::const_iterator PoseTrack::not_before(std::int64_t stamp_ns) const {
  return std::lower_bound(poses_.begin(), poses_.end(), stamp_ns,
                          [](const auto& pose, std::int64_t stamp) { return pose.first < stamp; });
}

}  // namespace glocal::bags
