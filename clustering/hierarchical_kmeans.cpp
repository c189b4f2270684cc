#include "clustering/hierarchical_kmeans.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace glocal {
namespace {

using Members = std::vector<std::size_t>;
using Centres = std::array<Pose2, 2>;

/// Squared distance with each axis in units of the largest allowed deviation, so that metres and radians add
/// up.
struct Metric {
  double per_m2;
  double per_rad2;

  [[nodiscard]] double squared(const Pose2& a, const Pose2& b) const {
    const double dx = a.x - b.x;
    const double dy = a.y - b.y;
    const double dtheta = wrap_angle(a.theta - b.theta);
    return (dx * dx + dy * dy) * per_m2 + dtheta * dtheta * per_rad2;
  }
};

std::size_t farthest_from(const Pose2& pose, const std::vector<Hypothesis>& hypotheses,
                          const Members& members, const Metric& metric) {
  const auto it = std::max_element(members.begin(), members.end(), [&](std::size_t a, std::size_t b) {
    return metric.squared(pose, hypotheses[a].map_from_robot) <
           metric.squared(pose, hypotheses[b].map_from_robot);
  });
  return *it;
}

/// Deterministic seeds far apart: the member farthest from the mean, and the member farthest from that.
Centres seeds(const Cluster& cluster, const std::vector<Hypothesis>& hypotheses, const Metric& metric) {
  const std::size_t first = farthest_from(cluster.map_from_robot, hypotheses, cluster.members, metric);
  const Pose2& first_pose = hypotheses[first].map_from_robot;
  const std::size_t second = farthest_from(first_pose, hypotheses, cluster.members, metric);
  return {first_pose, hypotheses[second].map_from_robot};
}

std::array<Members, 2> assign(const Members& members, const Centres& centres,
                              const std::vector<Hypothesis>& hypotheses, const Metric& metric) {
  std::array<Members, 2> halves;
  for (const std::size_t i : members) {
    const Pose2& pose = hypotheses[i].map_from_robot;
    const bool second = metric.squared(pose, centres[1]) < metric.squared(pose, centres[0]);
    halves[second ? 1 : 0].push_back(i);
  }
  return halves;
}

/// K-means with K = 2; one half is empty if all members coincide.
std::array<Members, 2> split(const Cluster& cluster, const std::vector<Hypothesis>& hypotheses,
                             const Metric& metric, int max_iterations) {
  Centres centres = seeds(cluster, hypotheses, metric);
  std::array<Members, 2> halves = assign(cluster.members, centres, hypotheses, metric);
  for (int i = 0; i < max_iterations && !halves[0].empty() && !halves[1].empty(); ++i) {
    centres = {make_cluster(hypotheses, halves[0]).map_from_robot,
               make_cluster(hypotheses, halves[1]).map_from_robot};
    std::array<Members, 2> next = assign(cluster.members, centres, hypotheses, metric);
    if (next == halves || next[0].empty() || next[1].empty()) break;
    halves = std::move(next);
  }
  return halves;
}

}  // namespace

void describe(ParamVisitor& v, HierarchicalKmeans::Params& p) {
  v.field("max_variance_translation", p.max_variance_translation,
          {.doc = "A cluster whose variance along x or y is larger is split.", .unit = "m^2", .above = 0.0});
  v.field("max_variance_rotation_deg2", p.max_variance_rotation_deg2,
          {.doc = "A cluster whose variance of heading is larger is split.", .unit = "deg^2", .above = 0.0});
  v.field("max_iterations", p.max_iterations,
          {.doc = "Rounds of assignment in each split; most end by themselves after a few.", .min = 1});
}

Cluster make_cluster(const std::vector<Hypothesis>& hypotheses, std::vector<std::size_t> members) {
  Cluster cluster;
  const auto n = static_cast<double>(members.size());
  double sine = 0.0;
  double cosine = 0.0;
  for (const std::size_t i : members) {
    const Pose2& pose = hypotheses[i].map_from_robot;
    cluster.map_from_robot.x += pose.x / n;
    cluster.map_from_robot.y += pose.y / n;
    sine += std::sin(pose.theta);
    cosine += std::cos(pose.theta);
  }
  cluster.map_from_robot.theta = std::atan2(sine, cosine);
  for (const std::size_t i : members) {
    const Pose2& pose = hypotheses[i].map_from_robot;
    const double dx = pose.x - cluster.map_from_robot.x;
    const double dy = pose.y - cluster.map_from_robot.y;
    const double dtheta = wrap_angle(pose.theta - cluster.map_from_robot.theta);
    cluster.variance_x += dx * dx / n;
    cluster.variance_y += dy * dy / n;
    cluster.variance_theta += dtheta * dtheta / n;
  }
  cluster.members = std::move(members);
  return cluster;
}

std::vector<Cluster> HierarchicalKmeans::cluster(const std::vector<Hypothesis>& hypotheses, Rng& /*rng*/) {
  if (hypotheses.empty()) return {};
  const double degree = radians(1.0);
  const double max_variance_rotation = params_.max_variance_rotation_deg2 * degree * degree;
  const Metric metric{1.0 / params_.max_variance_translation, 1.0 / max_variance_rotation};

  Members all(hypotheses.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  std::vector<Cluster> done;
  std::vector<Cluster> open;
  open.push_back(make_cluster(hypotheses, std::move(all)));
  while (!open.empty()) {
    Cluster cluster = std::move(open.back());
    open.pop_back();
    const bool compact =
        std::max(cluster.variance_x, cluster.variance_y) <= params_.max_variance_translation &&
        cluster.variance_theta <= max_variance_rotation;
    if (compact) {
      done.push_back(std::move(cluster));
      continue;
    }
    std::array<Members, 2> halves = split(cluster, hypotheses, metric, params_.max_iterations);
    open.push_back(make_cluster(hypotheses, std::move(halves[1])));
    open.push_back(make_cluster(hypotheses, std::move(halves[0])));
  }
  return done;
}

}  // namespace glocal
