#include "clustering/hierarchical_kmeans.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

namespace glocal {
namespace {

/// A hypothesis's robot pose, with what the inner loops would compute again and again.
struct Item {
  Pose2 pose;
  double cosine, sine;
  double weight;  ///< Proposals it stands for.
  std::size_t index;
};
using Items = std::span<Item>;

Item make_item(const Hypothesis& hypothesis, std::size_t index) {
  const Pose2& pose = hypothesis.map_from_robot;
  return {pose, std::cos(pose.theta), std::sin(pose.theta), static_cast<double>(hypothesis.support), index};
}

/// Between headings in [-pi, pi].
double angle_between(double a, double b) {
  const double d = std::abs(a - b);
  return std::min(d, 2.0 * std::numbers::pi - d);
}

/// Weighted sums, from which the mean pose comes; the heading's is circular.
struct Sums {
  double weight = 0.0, x = 0.0, y = 0.0, cosine = 0.0, sine = 0.0;

  void add(const Item& item) {
    weight += item.weight;
    x += item.weight * item.pose.x;
    y += item.weight * item.pose.y;
    cosine += item.weight * item.cosine;
    sine += item.weight * item.sine;
  }
  [[nodiscard]] Pose2 mean() const { return {x / weight, y / weight, std::atan2(sine, cosine)}; }
};

/// Mean pose and variances (eq. 6, diagonal only); members are left empty.
Cluster moments(std::span<const Item> items) {
  Sums sums;
  for (const Item& item : items) sums.add(item);
  Cluster cluster;
  cluster.map_from_robot = sums.mean();
  for (const Item& item : items) {
    const double share = item.weight / sums.weight;
    const double dx = item.pose.x - cluster.map_from_robot.x;
    const double dy = item.pose.y - cluster.map_from_robot.y;
    const double dtheta = angle_between(item.pose.theta, cluster.map_from_robot.theta);
    cluster.variance_x += share * dx * dx;
    cluster.variance_y += share * dy * dy;
    cluster.variance_theta += share * dtheta * dtheta;
  }
  return cluster;
}

/// Squared distance with each axis in units of the largest allowed deviation, so that metres and radians add
/// up.
struct Metric {
  double per_m2;
  double per_rad2;

  [[nodiscard]] double squared(const Pose2& a, const Pose2& b) const {
    const double dx = a.x - b.x;
    const double dy = a.y - b.y;
    const double dtheta = angle_between(a.theta, b.theta);
    return (dx * dx + dy * dy) * per_m2 + dtheta * dtheta * per_rad2;
  }
};

Pose2 farthest_from(const Pose2& pose, Items items, const Metric& metric) {
  const Item* farthest = nullptr;
  double largest = -1.0;
  for (const Item& item : items) {
    const double squared = metric.squared(pose, item.pose);
    if (squared > largest) {
      largest = squared;
      farthest = &item;
    }
  }
  return farthest->pose;
}

/// Splits items with K-means, K = 2, and moves those of the second half behind those of the first, otherwise
/// in order. Seeds are far apart: the item farthest from the mean, and the one farthest from that. Returns
/// the size of the first half; all of them if they coincide.
std::size_t split(Items items, const Pose2& mean, const Metric& metric, int max_iterations) {
  std::array<Pose2, 2> centres;
  centres[0] = farthest_from(mean, items, metric);
  centres[1] = farthest_from(centres[0], items, metric);
  std::vector<char> in_second(items.size(), 0);
  std::vector<char> next(items.size());
  for (int round = 0; round <= max_iterations; ++round) {
    std::array<Sums, 2> sums;
    for (std::size_t i = 0; i < items.size(); ++i) {
      const Pose2& pose = items[i].pose;
      const bool second = metric.squared(pose, centres[1]) < metric.squared(pose, centres[0]);
      next[i] = second ? 1 : 0;
      sums[second ? 1 : 0].add(items[i]);
    }
    if (next == in_second || sums[0].weight == 0.0 || sums[1].weight == 0.0) break;
    in_second.swap(next);
    centres = {sums[0].mean(), sums[1].mean()};
  }
  std::vector<Item> second_half;
  std::size_t first_size = 0;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (in_second[i] != 0) {
      second_half.push_back(items[i]);
    } else {
      items[first_size++] = items[i];
    }
  }
  std::copy(second_half.begin(), second_half.end(), items.begin() + static_cast<std::ptrdiff_t>(first_size));
  return first_size;
}

}  // namespace

void describe(ParamVisitor& v, HierarchicalKmeans::Params& p) {
  v.field("max_variance_translation", p.max_variance_translation,
          {.doc = "A cluster whose variance along x or y is larger is split.",
           .unit = "m^2",
           .above = 0.0,
           .audience = Audience::tuner});
  v.field("max_variance_rotation_deg2", p.max_variance_rotation_deg2,
          {.doc = "A cluster whose variance of heading is larger is split.",
           .unit = "deg^2",
           .above = 0.0,
           .audience = Audience::tuner});
  v.field("max_iterations", p.max_iterations,
          {.doc = "Rounds of assignment in each split; most end by themselves after a few.",
           .min = 1,
           .audience = Audience::expert});
}

Cluster make_cluster(const std::vector<Hypothesis>& hypotheses, std::vector<std::size_t> members) {
  std::vector<Item> items;
  items.reserve(members.size());
  for (const std::size_t i : members) items.push_back(make_item(hypotheses[i], i));
  Cluster cluster = moments(items);
  cluster.members = std::move(members);
  return cluster;
}

std::vector<Cluster> HierarchicalKmeans::cluster(const std::vector<Hypothesis>& hypotheses, Rng& /*rng*/) {
  if (hypotheses.empty()) return {};
  const double degree = radians(1.0);
  const double max_variance_rotation = params_.max_variance_rotation_deg2 * degree * degree;
  const Metric metric{1.0 / params_.max_variance_translation, 1.0 / max_variance_rotation};

  std::vector<Item> items;
  items.reserve(hypotheses.size());
  for (std::size_t i = 0; i < hypotheses.size(); ++i) items.push_back(make_item(hypotheses[i], i));
  std::vector<Cluster> done;
  std::vector<Items> open{items};
  while (!open.empty()) {
    const Items part = open.back();
    open.pop_back();
    Cluster cluster = moments(part);
    const bool compact =
        std::max(cluster.variance_x, cluster.variance_y) <= params_.max_variance_translation &&
        cluster.variance_theta <= max_variance_rotation;
    if (!compact) {
      const std::size_t first = split(part, cluster.map_from_robot, metric, params_.max_iterations);
      open.push_back(part.subspan(first));
      open.push_back(part.first(first));
      continue;
    }
    for (const Item& item : part) cluster.members.push_back(item.index);
    done.push_back(std::move(cluster));
  }
  return done;
}

}  // namespace glocal
