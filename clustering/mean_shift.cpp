#include "clustering/mean_shift.hpp"

#include <cmath>
#include <span>

#include "clustering/clusters_of.hpp"
#include "clustering/density_labels.hpp"
#include "glocal/pose_cells.hpp"

namespace glocal {
namespace {

/// A kernel on SE(2): how much a pose weighs, seen from another one.
struct Kernel {
  bool is_flat;
  PoseRadius bandwidth;

  /// In bandwidths; what is farther away does not count.
  [[nodiscard]] double reach() const { return is_flat ? 1.0 : 3.0; }
  /// Of the squared distance in bandwidths.
  [[nodiscard]] double weight(double squared) const {
    if (squared > reach() * reach()) return 0.0;
    return is_flat ? 1.0 : std::exp(-0.5 * squared);
  }
};

/// A difference of poses in the map's axes.
struct Shift {
  double x = 0.0, y = 0.0, theta = 0.0;

  [[nodiscard]] double squared(const PoseRadius& unit) const {
    return (x * x + y * y) / (unit.translation * unit.translation) +
           theta * theta / (unit.rotation * unit.rotation);
  }
  void add(const Shift& other, double weight) {
    x += weight * other.x;
    y += weight * other.y;
    theta += weight * other.theta;
  }
  void divide(double by) {
    x /= by;
    y /= by;
    theta /= by;
  }
};

Shift between(const Pose2& from, const Pose2& to) {
  return {to.x - from.x, to.y - from.y, wrap_angle(to.theta - from.theta)};
}

Pose2 moved(const Pose2& pose, const Shift& shift) {
  return {pose.x + shift.x, pose.y + shift.y, wrap_angle(pose.theta + shift.theta)};
}

/// Hypotheses that climb together.
struct Climbers {
  std::vector<Pose2> poses;
  std::vector<double> weights;
};

Climbers gather(const PoseCells& cells, std::span<const Pose2> poses, std::span<const double> weights) {
  Climbers result;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const Pose2& first = poses[cells.members(c).front()];
    Shift mean;
    double weight = 0.0;
    for (const std::size_t i : cells.members(c)) {
      mean.add(between(first, poses[i]), weights[i]);
      weight += weights[i];
    }
    mean.divide(weight);
    result.poses.push_back(moved(first, mean));
    result.weights.push_back(weight);
  }
  return result;
}

/// The mean shift at a pose.
Shift mean_shift(const Pose2& pose, const Climbers& all, const PoseCells& cells, const Kernel& kernel) {
  Shift mean;
  double weights = 0.0;
  cells.visit_near(cells.cell_of(pose), 1, 1, [&](std::size_t c) {
    for (const std::size_t i : cells.members(c)) {
      const Shift shift = between(pose, all.poses[i]);
      const double weight = all.weights[i] * kernel.weight(shift.squared(kernel.bandwidth));
      mean.add(shift, weight);
      weights += weight;
    }
    return true;
  });
  if (weights > 0.0) mean.divide(weights);
  return mean;
}

/// Where each climber ends.
std::vector<Pose2> modes_of(const Climbers& climbers, const Kernel& kernel, int max_iterations) {
  constexpr double still = 1e-3;  // bandwidths
  // Nothing counts that is more than one cell away.
  const PoseCells cells(climbers.poses, {kernel.reach() * kernel.bandwidth.translation,
                                         wide_parts_of_a_turn(kernel.reach() * kernel.bandwidth.rotation)});
  std::vector<Pose2> modes = climbers.poses;
  for (Pose2& mode : modes) {
    for (int i = 0; i < max_iterations; ++i) {
      const Shift shift = mean_shift(mode, climbers, cells, kernel);
      mode = moved(mode, shift);
      if (shift.squared(kernel.bandwidth) < still * still) break;
    }
  }
  return modes;
}

}  // namespace

void describe(ParamVisitor& v, MeanShift::Params& p) {
  v.field(
      "kernel", p.kernel,
      {.doc = "How hypotheses count: all alike within the bandwidths, or as a normal distribution cut off "
              "at three of them.",
       .choices = {"gaussian", "flat"}});
  v.field(
      "bandwidth", p.bandwidth,
      {.doc =
           "Unit of distance: the standard deviation of the gaussian kernel, or the radius of the flat one.",
       .unit = "m",
       .min = 0.001,
       .audience = Audience::tuner});
  v.field("bandwidth_rotation_deg", p.bandwidth_rotation_deg,
          {.doc = "Unit of rotation: as bandwidth, for the heading.",
           .unit = "deg",
           .min = 0.01,
           .max = 60.0,
           .audience = Audience::tuner});
  v.field("max_iterations", p.max_iterations,
          {.doc = "Steps of a climb; most end by themselves before.",
           .min = 1,
           .max = 100000,
           .audience = Audience::expert});
}

std::vector<Cluster> MeanShift::cluster(const std::vector<Hypothesis>& hypotheses, Rng& /*rng*/) {
  const Kernel kernel{params_.kernel == "flat", {params_.bandwidth, radians(params_.bandwidth_rotation_deg)}};
  const std::vector<Pose2> poses = robot_poses(hypotheses);
  const PoseCells together(
      poses, {0.25 * kernel.bandwidth.translation, parts_of_a_turn(0.25 * kernel.bandwidth.rotation)});
  const Climbers climbers = gather(together, poses, supports(hypotheses));
  const std::vector<Pose2> modes = modes_of(climbers, kernel, params_.max_iterations);
  // Without a least weight, poses near each other are simply linked.
  const std::vector<std::size_t> ends = density_labels(modes, climbers.weights, kernel.bandwidth, 0.0);
  std::vector<std::size_t> labels(hypotheses.size());
  for (std::size_t c = 0; c < together.size(); ++c) {
    for (const std::size_t i : together.members(c)) labels[i] = ends[c];
  }
  return clusters_of(hypotheses, labels);
}

}  // namespace glocal
