#include "clustering/density_labels.hpp"

#include <algorithm>
#include <numbers>

#include "clustering/disjoint_sets.hpp"
#include "clustering/pose_groups.hpp"
#include "glocal/pose_cells.hpp"

namespace glocal::clustering {
namespace {

/// Poses in the plane, in cells all of whose members are near each other.
class PlanarCells : public PoseCells {
 public:
  PlanarCells(std::span<const Pose2> poses, const PoseTolerance& radius)
      : PoseCells(poses, {radius.translation / std::numbers::sqrt2, parts_of_a_turn(radius.rotation)}) {}

  /// Those that can have poses near some of this one.
  template <class Visit>
  void visit_around(std::size_t number, Visit visit) const {
    // Cells are radius / sqrt(2) wide, and turns more than half the radius.
    constexpr int reach = 2;
    visit_near(cell(number), reach, reach, visit);
  }
};

/// The same of poses in space.
class SpatialCells : public PoseGroups {
 public:
  SpatialCells(std::span<const Pose3> poses, const PoseTolerance& radius)
      : PoseGroups(poses, radius), reach_{1.5 * radius.translation, 1.5 * radius.rotation} {}

  template <class Visit>
  void visit_around(std::size_t number, Visit visit) const {
    visit_near(leader(number), reach_, visit);
  }

 private:
  PoseTolerance reach_;  ///< From a leader to what is near one of its members.
};

template <class Pose, class Cells>
class DensityLabels {
 public:
  DensityLabels(std::span<const Pose> poses, std::span<const double> weights, const PoseTolerance& radius,
                double min_weight)
      : poses_(poses),
        weights_(weights),
        radius_(radius),
        min_weight_(min_weight),
        cells_(poses, radius),
        cores_(cells_.size()),
        sets_(poses.size()) {}

  [[nodiscard]] std::vector<std::size_t> find() {
    for (std::size_t c = 0; c < cells_.size(); ++c) find_cores(c);
    for (std::size_t c = 0; c < cells_.size(); ++c) join_near(c);
    std::vector<std::size_t> labels(poses_.size());
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      for (const std::size_t i : cells_.members(c)) labels[i] = label(c, i);
    }
    return labels;
  }

 private:
  [[nodiscard]] bool are_near(std::size_t i, std::size_t j) const {
    return radius_.are_near(poses_[i], poses_[j]);
  }

  /// Notes the cores of a cell; they are near each other.
  void find_cores(std::size_t c) {
    const auto members = cells_.members(c);
    double weight = 0.0;
    for (const std::size_t i : members) weight += weights_[i];
    for (const std::size_t i : members) {
      if (weight >= min_weight_ || is_core(c, i)) cores_[c].push_back(i);
    }
    for (const std::size_t i : cores_[c]) sets_.unite(cores_[c].front(), i);
  }

  [[nodiscard]] bool is_core(std::size_t c, std::size_t i) const {
    double weight = 0.0;
    cells_.visit_around(c, [&](std::size_t other) {
      for (const std::size_t j : cells_.members(other)) {
        if (are_near(i, j)) weight += weights_[j];
        if (weight >= min_weight_) return false;
      }
      return true;
    });
    return weight >= min_weight_;
  }

  /// Joins the cores of a cell with those of cells before it.
  void join_near(std::size_t c) {
    if (cores_[c].empty()) return;
    cells_.visit_around(c, [&](std::size_t other) {
      if (other < c && !cores_[other].empty()) join(cores_[c], cores_[other]);
      return true;
    });
  }

  void join(const std::vector<std::size_t>& a, const std::vector<std::size_t>& b) {
    if (sets_.find(a.front()) == sets_.find(b.front())) return;
    for (const std::size_t i : a) {
      if (std::ranges::any_of(b, [&](std::size_t j) { return are_near(i, j); })) {
        sets_.unite(i, b.front());
        return;
      }
    }
  }

  /// The first core of the pose's cluster, or the pose itself where there is none.
  [[nodiscard]] std::size_t label(std::size_t c, std::size_t i) {
    if (std::binary_search(cores_[c].begin(), cores_[c].end(), i)) return sets_.find(i);
    std::size_t first = poses_.size();
    cells_.visit_around(c, [&](std::size_t other) {
      const auto near = std::ranges::find_if(cores_[other], [&](std::size_t j) { return are_near(i, j); });
      if (near != cores_[other].end()) first = std::min(first, sets_.find(*near));
      return true;
    });
    return first == poses_.size() ? i : first;
  }

  std::span<const Pose> poses_;
  std::span<const double> weights_;
  PoseTolerance radius_;
  double min_weight_;
  Cells cells_;
  std::vector<std::vector<std::size_t>> cores_;  ///< Of each cell, ascending.
  DisjointSets sets_;                            ///< Cores of one cluster.
};

}  // namespace

std::vector<std::size_t> density_labels(std::span<const Pose2> poses, std::span<const double> weights,
                                        const PoseTolerance& radius, double min_weight) {
  return DensityLabels<Pose2, PlanarCells>(poses, weights, radius, min_weight).find();
}

std::vector<std::size_t> density_labels(std::span<const Pose3> poses, std::span<const double> weights,
                                        const PoseTolerance& radius, double min_weight) {
  return DensityLabels<Pose3, SpatialCells>(poses, weights, radius, min_weight).find();
}

}  // namespace glocal::clustering
