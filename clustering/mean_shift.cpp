#include "clustering/mean_shift.hpp"

#include <cmath>
#include <span>
#include <type_traits>

#include "clustering/density_labels.hpp"
#include "clustering/pose_groups.hpp"
#include "glocal/clusters_of.hpp"
#include "glocal/pose_cells.hpp"

namespace glocal::clustering {
namespace {

/// Unit of rotation: as the bandwidth is that of distance.
constexpr double bandwidth_rotation_deg = 8.0;

/// A kernel on SE(2) or SE(3): how much a pose weighs, seen from another one.
struct Kernel {
  bool is_flat;
  PoseTolerance bandwidth;

  /// In bandwidths; what is farther away does not count.
  [[nodiscard]] double reach() const { return is_flat ? 1.0 : 3.0; }
  /// The same in metres and radians.
  [[nodiscard]] PoseTolerance radius() const {
    return {reach() * bandwidth.translation, reach() * bandwidth.rotation};
  }
  /// Of the squared distance in bandwidths.
  [[nodiscard]] double weight(double squared) const {
    if (squared > reach() * reach()) return 0.0;
    return is_flat ? 1.0 : std::exp(-0.5 * squared);
  }
};

/// A difference of poses in the map's axes: the way, then the turn.
template <class Pose>
using Shift = Eigen::Matrix<double, std::is_same_v<Pose, Pose2> ? 3 : 6, 1>;

Shift<Pose2> shift_between(const Pose2& from, const Pose2& to) {
  return {to.x - from.x, to.y - from.y, wrap_angle(to.theta - from.theta)};
}
Shift<Pose3> shift_between(const Pose3& from, const Pose3& to) {
  Shift<Pose3> shift;
  shift << to.translation() - from.translation(), logarithm(composed(to.rotation, from.rotation.conjugate()));
  return shift;
}

double squared(const Shift<Pose2>& shift, const PoseTolerance& unit) {
  return (shift.x() * shift.x() + shift.y() * shift.y()) / (unit.translation * unit.translation) +
         shift.z() * shift.z() / (unit.rotation * unit.rotation);
}
double squared(const Shift<Pose3>& shift, const PoseTolerance& unit) {
  const double translation = shift.head<3>().norm() / unit.translation;
  const double rotation = shift.tail<3>().norm() / unit.rotation;
  return translation * translation + rotation * rotation;
}

// One divides and the other multiplies, as results of earlier versions do to the last bit.
void divide(Shift<Pose2>& shift, double by) {
  shift /= by;
}
void divide(Shift<Pose3>& shift, double by) {
  shift *= 1.0 / by;
}

Pose2 moved_by(const Pose2& pose, const Shift<Pose2>& shift) {
  return {pose.x + shift.x(), pose.y + shift.y(), wrap_angle(pose.theta + shift.z())};
}
Pose3 moved_by(const Pose3& pose, const Shift<Pose3>& shift) {
  return {pose.translation() + shift.head<3>(), composed(exponential(shift.tail<3>()), pose.rotation)};
}

/// Hypotheses that climb together.
template <class Pose>
struct Climbers {
  std::vector<Pose> poses;
  std::vector<double> weights;
};

/// `together`: poses in cells or groups.
template <class Pose, class Together>
Climbers<Pose> gather(const Together& together, std::span<const Pose> poses,
                      std::span<const double> weights) {
  Climbers<Pose> result;
  for (std::size_t c = 0; c < together.size(); ++c) {
    const Pose& first = poses[together.members(c).front()];
    Shift<Pose> mean = Shift<Pose>::Zero();
    double weight = 0.0;
    for (const std::size_t i : together.members(c)) {
      mean += weights[i] * shift_between(first, poses[i]);
      weight += weights[i];
    }
    divide(mean, weight);
    result.poses.push_back(moved_by(first, mean));
    result.weights.push_back(weight);
  }
  return result;
}

/// Poses sorted to find those within a radius of another one.
PoseCells sorted(std::span<const Pose2> poses, const PoseTolerance& radius) {
  return {poses, {radius.translation, wide_parts_of_a_turn(radius.rotation)}};
}
PoseGroups sorted(std::span<const Pose3> poses, const PoseTolerance& radius) {
  return {poses, radius};
}

/// Calls visit(number) for each cell or group that can have a pose within the radius they were sorted for.
template <class Visit>
void visit_around(const PoseCells& cells, const Pose2& pose, const PoseTolerance& /*radius*/, Visit visit) {
  // Nothing within the radius is more than one cell away.
  cells.visit_near(cells.cell_of(pose), 1, 1, visit);
}
template <class Visit>
void visit_around(const PoseGroups& groups, const Pose3& pose, const PoseTolerance& radius, Visit visit) {
  groups.visit_near(pose, radius, visit);
}

/// The mean shift at a pose.
template <class Pose, class Together>
Shift<Pose> mean_shift(const Pose& pose, const Climbers<Pose>& all, const Together& together,
                       const Kernel& kernel) {
  Shift<Pose> mean = Shift<Pose>::Zero();
  double weights = 0.0;
  visit_around(together, pose, kernel.radius(), [&](std::size_t c) {
    for (const std::size_t i : together.members(c)) {
      const Shift<Pose> shift = shift_between(pose, all.poses[i]);
      const double weight = all.weights[i] * kernel.weight(squared(shift, kernel.bandwidth));
      mean += weight * shift;
      weights += weight;
    }
    return true;
  });
  if (weights > 0.0) divide(mean, weights);
  return mean;
}

/// Where each climber ends.
template <class Pose>
std::vector<Pose> modes_of(const Climbers<Pose>& climbers, const Kernel& kernel) {
  constexpr double still = 1e-3;   // bandwidths
  constexpr int most_steps = 100;  // most climbs end by themselves before
  const auto together = sorted(climbers.poses, kernel.radius());
  std::vector<Pose> modes = climbers.poses;
  for (Pose& mode : modes) {
    for (int i = 0; i < most_steps; ++i) {
      const Shift<Pose> shift = mean_shift(mode, climbers, together, kernel);
      mode = moved_by(mode, shift);
      if (squared(shift, kernel.bandwidth) < still * still) break;
    }
  }
  return modes;
}

/// For each pose a number of its cluster, the same for all of them.
template <class Pose, class Together>
std::vector<std::size_t> labels_of(const Together& together, std::span<const Pose> poses,
                                   std::span<const double> weights, const Kernel& kernel) {
  const Climbers<Pose> climbers = gather(together, poses, weights);
  const std::vector<Pose> modes = modes_of(climbers, kernel);
  // Without a least weight, poses near each other are simply linked.
  const std::vector<std::size_t> ends = density_labels(modes, climbers.weights, kernel.bandwidth, 0.0);
  std::vector<std::size_t> labels(poses.size());
  for (std::size_t c = 0; c < together.size(); ++c) {
    for (const std::size_t i : together.members(c)) labels[i] = ends[c];
  }
  return labels;
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
}

std::vector<Cluster> MeanShift::cluster(const std::vector<Hypothesis>& hypotheses, Rng& /*rng*/) {
  const Kernel kernel{params_.kernel == "flat", {params_.bandwidth, radians(bandwidth_rotation_deg)}};
  const PoseTolerance near{0.25 * kernel.bandwidth.translation, 0.25 * kernel.bandwidth.rotation};
  const std::vector<double> weights = supports(hypotheses);
  const auto labels = [&](const auto& together, const auto& poses) {
    return labels_of(together, std::span(poses), std::span(weights), kernel);
  };
  if (are_planar(hypotheses)) {
    const std::vector<Pose2> poses = robot_poses<Pose2>(hypotheses);
    const PoseCells cells(poses, {near.translation, parts_of_a_turn(near.rotation)});
    return clusters_of(hypotheses, labels(cells, poses));
  }
  const std::vector<Pose3> poses = robot_poses<Pose3>(hypotheses);
  return clusters_of(hypotheses, labels(PoseGroups(poses, near), poses));
}

}  // namespace glocal::clustering
