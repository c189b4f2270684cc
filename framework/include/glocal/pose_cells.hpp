// Poses sorted into cells of SE(2), to find those near each other.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include "glocal/pose2.hpp"

namespace glocal {

/// A cell of x, y and heading.
struct PoseCell {
  std::int64_t turn = 0;  ///< From 0 on; 0 follows on the last one.
  std::int64_t row = 0;
  std::int64_t column = 0;

  friend bool operator==(const PoseCell&, const PoseCell&) = default;
  friend bool operator<(const PoseCell& a, const PoseCell& b) {
    return std::tie(a.turn, a.row, a.column) < std::tie(b.turn, b.row, b.column);
  }
};

/// Of the numbers of a cell, however many it has.
[[nodiscard]] std::size_t hash_of(std::span<const std::int64_t> numbers);

/// For hash tables of cells.
struct PoseCellHash {
  [[nodiscard]] std::size_t operator()(const PoseCell& cell) const;
};

/// Into how many equal parts of at most `width_rad` a full turn falls.
[[nodiscard]] int parts_of_a_turn(double width_rad);
/// The same, but a multiple of four: right angles then lie in the middle of their parts.
[[nodiscard]] int square_parts_of_a_turn(double width_rad);
/// Into how many equal parts of at least `width_rad`; at least 1.
[[nodiscard]] int wide_parts_of_a_turn(double width_rad);

/// Which cell a pose belongs to: squares times equal parts of a full turn. Multiples of the side lie at
/// borders of cells, but headings of multiples of 2 pi / turns in their middle: buildings have right angles.
struct PoseBinning {
  double side = 1.0;  ///< m
  int turns = 1;      ///< Parts of a full turn, at least 1.

  [[nodiscard]] PoseCell cell_of(const Pose2& pose) const;
};

/// Those of some poses' cells that hold any: only they take memory.
class PoseCells {
 public:
  PoseCells(std::span<const Pose2> poses, const PoseBinning& binning);

  /// How many cells hold poses; they are numbered from 0 on.
  [[nodiscard]] std::size_t size() const { return cells_.size(); }
  [[nodiscard]] const PoseCell& cell(std::size_t number) const { return cells_[number]; }
  /// Indexes of the poses in a cell, ascending.
  [[nodiscard]] std::span<const std::size_t> members(std::size_t number) const {
    return std::span(order_).subspan(starts_[number], starts_[number + 1] - starts_[number]);
  }
  /// Where a pose belongs.
  [[nodiscard]] PoseCell cell_of(const Pose2& pose) const { return binning_.cell_of(pose); }

  /// Calls visit(number) for each cell with poses that is at most `reach` rows and columns and `turn_reach`
  /// turns away, in a fixed order, until it returns false.
  template <class Visit>
  void visit_near(const PoseCell& centre, int reach, int turn_reach, Visit visit) const {
    const std::int64_t turns = binning_.turns;
    const std::int64_t around = std::min<std::int64_t>(turns, 2 * turn_reach + 1);
    for (std::int64_t k = 0; k < around; ++k) {
      const std::int64_t turn = (centre.turn - turn_reach + k + 2 * turns) % turns;
      for (std::int64_t row = centre.row - reach; row <= centre.row + reach; ++row) {
        const PoseCell last{turn, row, centre.column + reach};
        const PoseCell first{turn, row, centre.column - reach};
        for (auto it = std::lower_bound(cells_.begin(), cells_.end(), first);
             it != cells_.end() && !(last < *it); ++it) {
          if (!visit(static_cast<std::size_t>(it - cells_.begin()))) return;
        }
      }
    }
  }

 private:
  PoseBinning binning_;
  std::vector<std::size_t> order_;   ///< Poses, cell by cell.
  std::vector<PoseCell> cells_;      ///< Ascending.
  std::vector<std::size_t> starts_;  ///< Where each begins in order_; one more at the end.
};

}  // namespace glocal
