#include "glocal/moments.hpp"

#include <algorithm>
#include <utility>

namespace glocal {
namespace {

template <class Pose>
Sums<Pose> sums_of(std::span<const Item<Pose>> items, const Pose& near) {
  Sums<Pose> sums(near);
  for (const Item<Pose>& item : items) sums.add(item);
  return sums;
}

}  // namespace

Cluster moments(std::span<const Item<Pose2>> items) {
  const Sums<Pose2> sums = sums_of(items, items.front().pose);
  const Pose2 mean = sums.mean();
  Cluster cluster;
  cluster.map_from_robot = mean;
  for (const Item<Pose2>& item : items) {
    const double share = item.weight / sums.weight();
    const double dx = item.pose.x - mean.x;
    const double dy = item.pose.y - mean.y;
    const double dtheta = angle_between(item.pose.theta, mean.theta);
    cluster.variance_x += share * dx * dx;
    cluster.variance_y += share * dy * dy;
    cluster.variance_theta += share * dtheta * dtheta;
  }
  return cluster;
}

Cluster moments(std::span<const Item<Pose3>> items) {
  constexpr int most_steps = 20;
  constexpr double still = 1e-9;  // rad
  Sums<Pose3> sums = sums_of(items, items.front().pose);
  Pose3 mean = sums.mean();
  double turned = rotation_between(mean, items.front().pose);
  for (int step = 1; step < most_steps && turned > still; ++step) {
    sums = sums_of(items, mean);
    const Pose3 next = sums.mean();
    turned = rotation_between(mean, next);
    mean = next;
  }
  Cluster cluster;
  cluster.map_from_robot = mean;
  const Quaternion from_mean = mean.rotation.conjugate();
  for (const Item<Pose3>& item : items) {
    const double share = item.weight / sums.weight();
    const Vector3 off = item.pose.translation() - mean.translation();
    const Vector3 turn = logarithm(composed(item.pose.rotation, from_mean));
    cluster.variance_x += share * off.x() * off.x();
    cluster.variance_y += share * off.y() * off.y();
    cluster.variance_z += share * off.z() * off.z();
    cluster.variance_about_x += share * turn.x() * turn.x();
    cluster.variance_about_y += share * turn.y() * turn.y();
    cluster.variance_theta += share * turn.z() * turn.z();
  }
  return cluster;
}

bool are_planar(const std::vector<Hypothesis>& hypotheses) {
  return std::ranges::all_of(hypotheses, [](const Hypothesis& h) { return h.map_from_robot.is_planar(); });
}

Cluster make_cluster(const std::vector<Hypothesis>& hypotheses, std::vector<std::size_t> members) {
  const bool is_planar =
      std::ranges::all_of(members, [&](std::size_t i) { return hypotheses[i].map_from_robot.is_planar(); });
  Cluster cluster = is_planar ? moments(std::span<const Item<Pose2>>(items_of<Pose2>(hypotheses, members)))
                              : moments(std::span<const Item<Pose3>>(items_of<Pose3>(hypotheses, members)));
  cluster.members = std::move(members);
  return cluster;
}

}  // namespace glocal
