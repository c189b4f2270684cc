#include "local_mappers/correlative_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace glocal::local_mappers {

namespace {

constexpr std::size_t max_window =
    static_cast<std::size_t>(PointGrid::window_width) * PointGrid::window_width;

/// Sums of likelihoods of the points, for a block of shifts in x and y by whole cells.
using Sums = std::array<std::uint16_t, max_window>;

/// Hits that are looked at: more find no better pose, and cost as much more.
constexpr std::size_t max_points = 100;
static_assert(max_points <= 65535 / PointGrid::likelihood_one, "16 bits hold the sum of so many likelihoods");

/// Hits 3 m away move by a cell.
constexpr double rotation_step_deg = 1.0;
/// Largest rotation tried from the predicted one, in steps.
constexpr int turns = 9;

/// Shifts by first_column … + PointGrid::window_width - 1 and by first_row … + rows - 1 cells, tried
/// together.
struct Block {
  int first_column;
  int first_row;
  int rows;
};

/// Hits spread evenly over the scan.
Points spread_hits(const Points& hits) {
  Points chosen;
  const std::size_t n = std::min(hits.size(), max_points);
  chosen.reserve(n);
  for (std::size_t i = 0; i < n; ++i) chosen.push_back(hits[(2 * i + 1) * hits.size() / (2 * n)]);
  return chosen;
}

/// The cells that hits fall in; hits the grid cannot hold are left out.
void find_cells(const PointGrid& grid, const Points& hits, const Pose2& local_from_robot,
                std::vector<GridCell>& cells) {
  const Transform transform(local_from_robot);
  cells.clear();
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const Point p = transform(hits[i]);
    if (grid.contains(p.x, p.y)) cells.push_back(grid.cell(p.x, p.y));
  }
}

/// All shifts of a block at once: a window of likelihoods for each cell is added up.
void add_windows(const PointGrid& grid, const std::vector<GridCell>& cells, const Block& block, Sums& sums) {
  const std::size_t size = static_cast<std::size_t>(block.rows) * PointGrid::window_width;
  std::array<std::uint8_t, max_window> window;
  std::fill_n(sums.begin(), size, std::uint16_t{0});
  for (const GridCell& cell : cells) {
    grid.likelihood_rows({cell.column + block.first_column, cell.row + block.first_row}, block.rows,
                         window.data());
    for (std::size_t k = 0; k < size; ++k) sums[k] = static_cast<std::uint16_t>(sums[k] + window[k]);
  }
}

/// (part / whole)^2, and nothing of nothing.
double square_share(int part, int whole) {
  if (whole == 0) return 0.0;
  const double share = static_cast<double>(part) / whole;
  return share * share;
}

/// Tries poses and remembers the best.
class Search {
 public:
  Search(const PointGrid& grid, Points hits, const Pose2& predicted, double translation,
         double odometry_penalty)
      : grid_(grid),
        hits_(std::move(hits)),
        predicted_(predicted),
        odometry_penalty_(odometry_penalty),
        shift_(static_cast<int>(std::lround(translation / grid.resolution()))),
        scale_(1.0 / (PointGrid::likelihood_one * static_cast<double>(hits_.size()))) {
    cells_.reserve(hits_.size());
  }

  /// All shifts at one rotation from the predicted pose; `penalty` is what odometry has against it.
  void try_rotation(double rotation, double penalty) {
    const Pose2 turned{predicted_.x, predicted_.y, wrap_angle(predicted_.theta + rotation)};
    find_cells(grid_, hits_, turned, cells_);
    for (int row = -shift_; row <= shift_; row += PointGrid::window_width) {
      for (int column = -shift_; column <= shift_; column += PointGrid::window_width) {
        const Block block{column, row, std::min(PointGrid::window_width, shift_ - row + 1)};
        add_windows(grid_, cells_, block, sums_);
        rate(block, turned, penalty);
      }
    }
  }

  [[nodiscard]] const SearchResult& best() const { return best_; }

 private:
  void rate(const Block& block, const Pose2& turned, double penalty) {
    auto row_sums = sums_.begin();
    for (int row = block.first_row; row < block.first_row + block.rows;
         ++row, row_sums += PointGrid::window_width) {
      const int columns = std::min(PointGrid::window_width, shift_ - block.first_column + 1);
      for (int i = 0; i < columns; ++i) {
        const int column = block.first_column + i;
        const double likelihood = row_sums[i] * scale_;
        const double score = likelihood - penalty -
                             odometry_penalty_ * (square_share(row, shift_) + square_share(column, shift_));
        if (score <= best_score_) continue;
        best_score_ = score;
        const double resolution = grid_.resolution();
        best_ = {{turned.x + column * resolution, turned.y + row * resolution, turned.theta}, likelihood};
      }
    }
  }

  const PointGrid& grid_;
  Points hits_;
  Pose2 predicted_;
  double odometry_penalty_;
  int shift_;     ///< Farthest, in cells.
  double scale_;  ///< From sums to mean likelihoods.
  std::vector<GridCell> cells_;
  Sums sums_{};
  SearchResult best_;
  double best_score_ = -std::numeric_limits<double>::infinity();
};

}  // namespace

void describe(ParamVisitor& v, CorrelativeSearchParams& p) {
  v.field("translation", p.translation,
          {.doc = "Farthest pose tried from the one odometry predicts, along x and along y.",
           .unit = "m",
           .min = 0.0,
           .max = 10.0});
}

SearchResult correlative_search(const PointGrid& grid, const Points& hits, const Pose2& predicted,
                                const CorrelativeSearchParams& params, double odometry_penalty) {
  if (hits.empty()) return {predicted, 0.0};
  Search search(grid, spread_hits(hits), predicted, params.translation, odometry_penalty);
  for (int turn = -turns; turn <= turns; ++turn) {
    search.try_rotation(turn * radians(rotation_step_deg), odometry_penalty * square_share(turn, turns));
  }
  return search.best();
}

}  // namespace glocal::local_mappers
