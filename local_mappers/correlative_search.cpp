#include "local_mappers/correlative_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace glocal {

namespace {

/// Half a window: as many cells can be tried on each side.
constexpr int max_shift = (PointGrid::window_width - 1) / 2;
constexpr std::size_t max_window = static_cast<std::size_t>(PointGrid::window_width) * (2 * max_shift + 1);

/// Sums of likelihoods of the points, for every shift in x and y by whole cells.
using Sums = std::array<std::uint16_t, max_window>;

/// 16 bits hold the sum of so many likelihoods.
constexpr int max_points = 65535 / PointGrid::likelihood_one;

/// Hits spread evenly over the scan.
Points spread_hits(const Points& hits, int wanted) {
  Points chosen;
  const std::size_t n = std::min(hits.size(), static_cast<std::size_t>(wanted));
  chosen.reserve(n);
  for (std::size_t i = 0; i < n; ++i) chosen.push_back(hits[(2 * i + 1) * hits.size() / (2 * n)]);
  return chosen;
}

/// One rotation, all shifts: a point's window of cells is added to the sums at once.
void add_windows(const PointGrid& grid, const Points& hits, const Pose2& local_from_robot, int shift,
                 Sums& sums) {
  const int rows = 2 * shift + 1;
  const std::size_t cells = static_cast<std::size_t>(rows) * PointGrid::window_width;
  const Transform transform(local_from_robot);
  std::array<std::uint8_t, max_window> window;
  std::fill_n(sums.begin(), cells, std::uint16_t{0});
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const Point p = transform(hits[i]);
    if (!grid.contains(p.x, p.y)) continue;
    const GridCell cell = grid.cell(p.x, p.y);
    grid.likelihood_rows({cell.column - shift, cell.row - shift}, rows, window.data());
    for (std::size_t k = 0; k < cells; ++k) sums[k] = static_cast<std::uint16_t>(sums[k] + window[k]);
  }
}

double square(double x) {
  return x * x;
}

}  // namespace

void describe(ParamVisitor& v, CorrelativeSearchParams& p) {
  v.field("translation", p.translation,
          {.doc = "Farthest pose tried from the one odometry predicts, along x and along y; at most 7 cells.",
           .unit = "m",
           .min = 0.0});
  v.field("rotation", p.rotation,
          {.doc = "Largest rotation tried from the one odometry predicts.",
           .unit = "rad",
           .min = 0.0,
           .max = 3.2});
  v.field("rotation_step", p.rotation_step,
          {.doc = "Step between rotations tried.", .unit = "rad", .min = 0.001, .max = 1.0});
  v.field("points", p.points,
          {.doc = "Hits of a scan used in the search, spread evenly over its beams.",
           .min = 1,
           .max = max_points});
  v.field("odometry_penalty", p.odometry_penalty,
          {.doc = "What a pose at the border of the search loses in likelihood; grows with the square of the "
                  "deviation.",
           .min = 0.0,
           .max = 1.0});
}

SearchResult correlative_search(const PointGrid& grid, const Points& hits, const Pose2& predicted,
                                const CorrelativeSearchParams& params) {
  const Points chosen = spread_hits(hits, params.points);
  if (chosen.empty()) return {predicted, 0.0};
  const int shift =
      std::min(max_shift, static_cast<int>(std::lround(params.translation / grid.resolution())));
  const int turns = static_cast<int>(std::lround(params.rotation / params.rotation_step));
  const double scale = 1.0 / (PointGrid::likelihood_one * static_cast<double>(chosen.size()));
  Sums sums;
  SearchResult best{predicted, 0.0};
  double best_score = -1e9;
  for (int turn = -turns; turn <= turns; ++turn) {
    Pose2 pose = predicted;
    pose.theta = wrap_angle(predicted.theta + turn * params.rotation_step);
    add_windows(grid, chosen, pose, shift, sums);
    const double turn_penalty = turns == 0 ? 0.0 : square(static_cast<double>(turn) / turns);
    for (int row = -shift; row <= shift; ++row) {
      for (int column = -shift; column <= shift; ++column) {
        const auto k = static_cast<std::size_t>((row + shift) * PointGrid::window_width + column + shift);
        const double likelihood = sums[k] * scale;
        const double shift_penalty = shift == 0 ? 0.0 : (square(row) + square(column)) / square(shift);
        const double score = likelihood - params.odometry_penalty * (turn_penalty + shift_penalty);
        if (score <= best_score) continue;
        best_score = score;
        best.likelihood = likelihood;
        best.local_from_robot = {predicted.x + column * grid.resolution(),
                                 predicted.y + row * grid.resolution(), pose.theta};
      }
    }
  }
  return best;
}

}  // namespace glocal
