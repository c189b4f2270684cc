#include "clustering/pose_groups.hpp"

#include <algorithm>
#include <cmath>

namespace glocal::clustering {

PoseGroups::PoseGroups(std::span<const Pose3> poses, const PoseTolerance& radius)
    : half_{0.5 * radius.translation, 0.5 * radius.rotation}, side_(2.0 * radius.translation) {
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const std::size_t none = size();
    std::size_t first = none;
    visit_leaders(poses[i], half_, [&](std::size_t group) {
      first = std::min(first, group);
      return true;
    });
    if (first == none) {
      leaders_.push_back(poses[i]);
      members_.emplace_back();
      groups_in_[cell_of(poses[i])].push_back(first);
    }
    members_[first].push_back(i);
  }
}

PoseGroups::Cell PoseGroups::cell_of(const Pose3& pose) const {
  const auto part = [this](double value) { return static_cast<std::int64_t>(std::floor(value / side_)); };
  return {part(pose.x), part(pose.y), part(pose.z)};
}

}  // namespace glocal::clustering
