#include "matchers/grid_search/best_poses.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <tuple>

namespace glocal {
namespace {

bool is_better(const GridPose& a, const GridPose& b) {
  return std::tie(b.in_contact, a.rotation, a.layer, a.row, a.column) <
         std::tie(a.in_contact, b.rotation, b.layer, b.row, b.column);
}

/// How many points must be in contact for a share of them; at least one.
std::size_t least_in_contact(double share, std::size_t points) {
  const auto n = static_cast<double>(points);
  auto least = static_cast<std::size_t>(std::max(1.0, std::floor(share * n)));
  while (static_cast<double>(least) / n < share) ++least;
  return least;
}

}  // namespace

RobotCells::RobotCells(const Pose2& robot_at_zero, double height_at_zero, double cell,
                       const GridSearchRule& rule)
    : robot_at_zero_(robot_at_zero),
      height_at_zero_(height_at_zero),
      cell_(cell),
      binning_{rule.distance / std::numbers::sqrt2, square_parts_of_a_turn(rule.rotation)} {}

RobotCell RobotCells::of(const GridPose& pose) const {
  const double height = height_at_zero_ + cell_ * pose.layer;
  return {binning_.cell_of({robot_at_zero_.x + cell_ * pose.column, robot_at_zero_.y + cell_ * pose.row,
                            robot_at_zero_.theta}),
          static_cast<std::int64_t>(std::floor(height / binning_.side))};
}

void add(BestOfCells& best, const RobotCell& cell, const GridPose& pose) {
  const auto [place, is_new] = best.try_emplace(cell, pose);
  if (!is_new && is_better(pose, place->second)) place->second = pose;
}

BestPoses::BestPoses(const GridSearchRule& rule, std::size_t points)
    : most_(rule.max_poses), least_(least_in_contact(rule.min_quality, points)) {}

void BestPoses::add(const std::vector<FoundPoses>& found) {
  for (const FoundPoses& rotation : found) {
    for (const auto& [cell, pose] : rotation.best) {
      if (pose.in_contact >= least_) glocal::add(best_, cell, pose);
    }
    tested_ += rotation.tested;
    points_tested_ += rotation.points_tested;
  }
  raise();
}

void BestPoses::raise() {
  if (best_.size() < most_) return;
  std::vector<std::size_t> contacts;
  for (const auto& [cell, pose] : best_) contacts.push_back(pose.in_contact);
  const auto last = contacts.begin() + static_cast<std::ptrdiff_t>(most_) - 1;
  std::nth_element(contacts.begin(), last, contacts.end(), std::greater<>());
  least_ = *last + 1;
  std::erase_if(best_, [&](const auto& entry) { return entry.second.in_contact < *last; });
}

GridSearchResult BestPoses::result(const PoseGrid& grid, const CellFrame& frame) const {
  GridSearchResult result{.poses = {}, .tested = tested_, .points_tested = points_tested_};
  for (const GridPose& pose : poses()) {
    result.poses.push_back({grid.pose(pose.rotation, pose.column, pose.row, frame.min_x, frame.min_y),
                            frame.min_z + frame.cell * pose.layer, pose.in_contact});
  }
  return result;
}

std::vector<GridPose> BestPoses::poses() const {
  std::vector<GridPose> poses;
  for (const auto& [cell, pose] : best_) poses.push_back(pose);
  std::sort(poses.begin(), poses.end(), is_better);
  if (poses.size() > most_) poses.resize(most_);
  return poses;
}

}  // namespace glocal
