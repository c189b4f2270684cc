#include "clustering/hierarchical_kmeans.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <utility>

#include "glocal/moments.hpp"

namespace glocal::clustering {
namespace {

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
  [[nodiscard]] double squared(const Pose3& a, const Pose3& b) const {
    const Vector3 off = a.translation() - b.translation();
    const double angle = rotation_between(a, b);
    return off.squaredNorm() * per_m2 + angle * angle * per_rad2;
  }
};

template <class Pose>
Pose farthest_from(const Pose& pose, std::span<const Item<Pose>> items, const Metric& metric) {
  const Item<Pose>* farthest = nullptr;
  double largest = -1.0;
  for (const Item<Pose>& item : items) {
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
template <class Pose>
std::size_t split(std::span<Item<Pose>> items, const Pose& mean, const Metric& metric) {
  constexpr int most_rounds = 20;  // of assignment; most splits end by themselves after a few
  std::array<Pose, 2> centres;
  centres[0] = farthest_from<Pose>(mean, items, metric);
  centres[1] = farthest_from<Pose>(centres[0], items, metric);
  std::vector<char> in_second(items.size(), 0);
  std::vector<char> next(items.size());
  for (int round = 0; round <= most_rounds; ++round) {
    std::array sums{Sums<Pose>(centres[0]), Sums<Pose>(centres[1])};
    for (std::size_t i = 0; i < items.size(); ++i) {
      const Pose& pose = items[i].pose;
      const bool second = metric.squared(pose, centres[1]) < metric.squared(pose, centres[0]);
      next[i] = second ? 1 : 0;
      sums[second ? 1 : 0].add(items[i]);
    }
    if (next == in_second || sums[0].weight() == 0.0 || sums[1].weight() == 0.0) break;
    in_second.swap(next);
    centres = {sums[0].mean(), sums[1].mean()};
  }
  std::vector<Item<Pose>> second_half;
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

/// The largest variances that a cluster may have about any axis.
struct Limits {
  double translation;  ///< m^2
  double rotation;     ///< rad^2

  [[nodiscard]] bool hold(const Cluster& cluster) const {
    return std::max({cluster.variance_x, cluster.variance_y, cluster.variance_z}) <= translation &&
           std::max({cluster.variance_theta, cluster.variance_about_x, cluster.variance_about_y}) <= rotation;
  }
};

/// Splits all that is wider than the limits.
template <class Pose>
std::vector<Cluster> split_all(std::vector<Item<Pose>> items, const Limits& limits) {
  const Metric metric{1.0 / limits.translation, 1.0 / limits.rotation};
  std::vector<Cluster> done;
  std::vector<std::span<Item<Pose>>> open{items};
  while (!open.empty()) {
    const std::span<Item<Pose>> part = open.back();
    open.pop_back();
    Cluster cluster = moments(part);
    const bool is_wide = !limits.hold(cluster);
    const std::size_t first =
        is_wide ? split(part, pose_as<Pose>(cluster.map_from_robot), metric) : part.size();
    // Poses that coincide but for rounding cannot be split, however narrow the limits are.
    if (first < part.size()) {
      open.push_back(part.subspan(first));
      open.push_back(part.first(first));
      continue;
    }
    for (const Item<Pose>& item : part) cluster.members.push_back(item.index);
    done.push_back(std::move(cluster));
  }
  return done;
}

}  // namespace

void describe(ParamVisitor& v, HierarchicalKmeans::Params& p) {
  constexpr double least_variance = 1e-12;  // distances are divided by it, and stay finite
  v.field("max_variance_translation", p.max_variance_translation,
          {.doc = "A cluster whose variance along x, y or z is larger is split.",
           .unit = "m^2",
           .min = least_variance,
           .audience = Audience::tuner});
  v.field(
      "max_variance_rotation_deg2", p.max_variance_rotation_deg2,
      {.doc = "A cluster whose variance of heading, or of rotation about another axis, is larger is split.",
       .unit = "deg^2",
       .min = least_variance,
       .audience = Audience::tuner});
}

std::vector<Cluster> HierarchicalKmeans::cluster(const std::vector<Hypothesis>& hypotheses, Rng& /*rng*/) {
  if (hypotheses.empty()) return {};
  const double degree = radians(1.0);
  const Limits limits{params_.max_variance_translation, params_.max_variance_rotation_deg2 * degree * degree};
  std::vector<std::size_t> all(hypotheses.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return are_planar(hypotheses) ? split_all(items_of<Pose2>(hypotheses, all), limits)
                                : split_all(items_of<Pose3>(hypotheses, all), limits);
}

}  // namespace glocal::clustering
