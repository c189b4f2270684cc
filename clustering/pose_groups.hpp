// Poses in space, sorted to find those near each other.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "glocal/pose3.hpp"
#include "glocal/pose_cells.hpp"
#include "glocal/pose_tolerance.hpp"

namespace glocal::clustering {

/// What PoseCells are in the plane: poses in groups all of whose members are near each other. Each pose joins
/// the first group whose leader, its first member, is within half the radius, or leads a new one. There is no
/// grid of rotations to be cut into equal cells, so leaders are found by their place alone and then compared.
class PoseGroups {
 public:
  PoseGroups(std::span<const Pose3> poses, const PoseTolerance& radius);

  /// How many groups there are; they are numbered from 0 on, in the order of their leaders.
  [[nodiscard]] std::size_t size() const { return members_.size(); }
  /// Indexes of the poses in a group, ascending.
  [[nodiscard]] std::span<const std::size_t> members(std::size_t number) const { return members_[number]; }
  [[nodiscard]] const Pose3& leader(std::size_t number) const { return leaders_[number]; }

  /// Calls visit(number) for each group that can have a pose within `reach` of this one, in a fixed order,
  /// until it returns false. `reach` is at most one and a half times the radius.
  template <class Visit>
  void visit_near(const Pose3& pose, const PoseTolerance& reach, Visit visit) const {
    visit_leaders(pose, {reach.translation + half_.translation, reach.rotation + half_.rotation}, visit);
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  struct CellHash {
    std::size_t operator()(const Cell& cell) const { return hash_of(cell); }
  };

  [[nodiscard]] Cell cell_of(const Pose3& pose) const;

  /// Those within `reach`, at most the side of a cell.
  template <class Visit>
  void visit_leaders(const Pose3& pose, const PoseTolerance& reach, Visit visit) const {
    const Cell centre = cell_of(pose);
    for (std::int64_t k = 0; k < 27; ++k) {
      const auto found =
          groups_in_.find({centre[0] + k / 9 - 1, centre[1] + k / 3 % 3 - 1, centre[2] + k % 3 - 1});
      if (found == groups_in_.end()) continue;
      for (const std::size_t group : found->second) {
        if (reach.are_near(leaders_[group], pose) && !visit(group)) return;
      }
    }
  }

  PoseTolerance half_;
  double side_;  ///< Of a cell, m.
  std::vector<Pose3> leaders_;
  std::vector<std::vector<std::size_t>> members_;
  std::unordered_map<Cell, std::vector<std::size_t>, CellHash> groups_in_;  ///< By the leader's place.
};

}  // namespace glocal::clustering
