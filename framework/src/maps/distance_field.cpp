#include "glocal/distance_field.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "glocal/error.hpp"
#include "glocal/extent.hpp"
#include "glocal/parallel.hpp"
#include "maps/look_up.hpp"

namespace glocal {

namespace {

/// Numbers of points sorted by tile.
struct PointsByTile {
  std::vector<std::uint32_t> numbers;
  std::vector<std::size_t> begins;  ///< Of each tile's, and the end of all.
};

template <class TileOf>
PointsByTile sorted_by_tile(std::size_t points, std::size_t tiles, TileOf tile_of) {
  PointsByTile sorted{std::vector<std::uint32_t>(points), std::vector<std::size_t>(tiles + 1, 0)};
  for (std::size_t i = 0; i < points; ++i) ++sorted.begins[tile_of(i) + 1];
  std::partial_sum(sorted.begins.begin(), sorted.begins.end(), sorted.begins.begin());
  std::vector<std::size_t> next(sorted.begins.begin(), sorted.begins.end() - 1);
  for (std::size_t i = 0; i < points; ++i) sorted.numbers[next[tile_of(i)]++] = static_cast<std::uint32_t>(i);
  return sorted;
}

[[noreturn]] void refuse_size() {
  throw ConfigError("",
                    "the map is too large for a distance field: it would need more than 1 GiB; cut the map");
}

}  // namespace

DistanceField::DistanceField(const Points& points, double resolution, double reach, int threads)
    : scale_(static_cast<float>(1.0 / resolution)),
      reach_(static_cast<float>(reach)),
      step_(reach_ / static_cast<float>(beyond_reach)) {
  const Extent x = extent_of(points.x), y = extent_of(points.y);
  min_x_ = x.low - reach_;
  min_y_ = y.low - reach_;
  const double columns = std::ceil((x.length() + 2.0 * reach) / resolution) + 2.0;
  const double rows = std::ceil((y.length() + 2.0 * reach) / resolution) + 2.0;
  constexpr double most_tiles = 67108864.0;  // whose numbers take a quarter of a GiB
  if (!(columns * rows <= most_tiles * tile_side * tile_side)) refuse_size();
  columns_ = static_cast<int>(columns);
  rows_ = static_cast<int>(rows);
  tile_columns_ = (columns_ - 1) / tile_side + 1;
  tile_rows_ = (rows_ - 1) / tile_side + 1;
  const int around = static_cast<int>(std::ceil(reach / resolution));
  place_tiles(points, around);
  fill(points, around, threads);
}

/// Gives room to each tile that a point can reach into.
void DistanceField::place_tiles(const Points& points, int around) {
  std::vector<bool> reached(static_cast<std::size_t>(tile_columns_) * static_cast<std::size_t>(tile_rows_));
  // A tile has the first cells of the next one.
  const auto first = [&](int cell) { return std::max(0, cell - around - 1) >> tile_shift; };
  const auto last = [&](int cell, int tiles) { return std::min(tiles - 1, (cell + around) >> tile_shift); };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto [u, v] = place_of(points.x[i], points.y[i]);
    const int column = static_cast<int>(std::lround(u));
    const int row = static_cast<int>(std::lround(v));
    for (int r = first(row); r <= last(row, tile_rows_); ++r) {
      for (int c = first(column); c <= last(column, tile_columns_); ++c)
        reached[tile_of(c * tile_side, r * tile_side)] = true;
    }
  }
  const auto n = static_cast<std::size_t>(std::count(reached.begin(), reached.end(), true)) + 1;
  constexpr std::size_t largest_bytes = std::size_t{1} << 30U;
  if (n * tile_cells > largest_bytes) refuse_size();
  constexpr std::size_t padding = 2;
  cells_.assign(n * tile_cells + padding, beyond_reach);
  tiles_.assign(reached.size(), 0);
  std::uint32_t next = 1;
  for (std::size_t i = 0; i < reached.size(); ++i) {
    if (reached[i]) tiles_[i] = next++;
  }
}

void DistanceField::fill(const Points& points, int around, int threads) {
  const PointsByTile by_tile = sorted_by_tile(points.size(), tiles_.size(), [&](std::size_t i) {
    const auto [u, v] = place_of(points.x[i], points.y[i]);
    return tile_of(static_cast<int>(std::lround(u)), static_cast<int>(std::lround(v)));
  });
  const int tiles_around = around / tile_side + 1;
  parallel_for(threads, static_cast<std::size_t>(tile_rows_), [&](std::size_t tile_row) {
    const int row = static_cast<int>(tile_row);
    std::vector<std::uint32_t> near;
    for (int column = 0; column < tile_columns_; ++column) {
      const std::size_t tile = tile_of(column * tile_side, row * tile_side);
      if (tiles_[tile] == 0) continue;
      near.clear();
      for (int r = std::max(0, row - tiles_around); r <= std::min(tile_rows_ - 1, row + tiles_around); ++r) {
        const int left = std::max(0, column - tiles_around);
        const int right = std::min(tile_columns_ - 1, column + tiles_around);
        const std::size_t begin = by_tile.begins[tile_of(left * tile_side, r * tile_side)];
        const std::size_t end = by_tile.begins[tile_of(right * tile_side, r * tile_side) + 1];
        near.insert(near.end(), by_tile.numbers.begin() + static_cast<std::ptrdiff_t>(begin),
                    by_tile.numbers.begin() + static_cast<std::ptrdiff_t>(end));
      }
      stamp(tile, points, near, around);
    }
  });
}

/// Writes the distances of a tile's cells to the points near it.
void DistanceField::stamp(std::size_t tile, const Points& points, std::span<const std::uint32_t> near,
                          int around) {
  const int first_column = static_cast<int>(tile % static_cast<std::size_t>(tile_columns_)) * tile_side;
  const int first_row = static_cast<int>(tile / static_cast<std::size_t>(tile_columns_)) * tile_side;
  const float farthest = reach_ * scale_;
  constexpr std::size_t padded = std::size_t{(stride + 3) / 4} * 4;  // whole vectors
  std::array<float, padded * stride> squares;                        // in cells
  squares.fill(farthest * farthest);
  std::array<float, padded> across;
  for (const std::uint32_t i : near) {
    const auto [u, v] = place_of(points.x[i], points.y[i]);
    const float x = u - static_cast<float>(first_column);
    const float y = v - static_cast<float>(first_row);
    const auto beside = static_cast<float>(around);
    constexpr auto end = static_cast<float>(stride);
    if (x < -beside || x > end + beside || y < -beside || y > end + beside) continue;
    for (std::size_t c = 0; c < padded; ++c) {
      const float dx = static_cast<float>(static_cast<int>(c)) - x;
      across[c] = dx * dx;
    }
    const int first = std::max(0, static_cast<int>(y + 1.0F) - around - 1);
    const int last = std::min(stride - 1, static_cast<int>(y + 1.0F) + around);
    for (int r = first; r <= last; ++r) {
      const float dy = static_cast<float>(r) - y;
      float* line = &squares[static_cast<std::size_t>(r) * padded];
      for (std::size_t c = 0; c < padded; ++c) line[c] = std::min(line[c], across[c] + dy * dy);
    }
  }
  std::uint8_t* cells = cells_.data() + tiles_[tile] * tile_cells;
  for (std::size_t r = 0; r < stride; ++r) {
    for (std::size_t c = 0; c < stride; ++c) {
      // Rounded in a way that a vector loop can, half up.
      const float steps = std::sqrt(squares[r * padded + c]) / farthest * beyond_reach;
      const int whole = static_cast<int>(steps);
      *cells++ = static_cast<std::uint8_t>(steps - static_cast<float>(whole) >= 0.5F ? whole + 1 : whole);
    }
  }
}

void DistanceField::at(const Points& points, const Transform& map_from_points, FieldValues& values) const {
  for (auto* of_each : {&values.x, &values.y, &values.distance, &values.dx, &values.dy})
    of_each->resize(points.size());
  look_up({.cells = cells_.data(),
           .tiles = tiles_.data(),
           .min_x = min_x_,
           .min_y = min_y_,
           .scale = scale_,
           .step = step_,
           .reach = reach_,
           .columns = columns_,
           .rows = rows_,
           .tile_columns = tile_columns_},
          points, map_from_points, values);
}

std::shared_ptr<const DistanceField> distance_field(const GlobalMap& map, int threads) {
  const double cell = area_of(map.points()) > huge_area ? 0.1 : 0.05;
  // Half a metre is as far as a pose is ever refined from.
  return map.index<DistanceField>("", [&] { return DistanceField(map.points(), cell, 0.5, threads); });
}

namespace {

/// Of the sum of weighted squared distances, about a pose that is turned around `about`.
struct NormalEquations {
  Eigen::Matrix3f h = Eigen::Matrix3f::Zero();
  Eigen::Vector3f g = Eigen::Vector3f::Zero();
  float weights = 0.0F;
  float squares = 0.0F;  ///< m^2
};

/// `values` is memory to work with.
NormalEquations normal_equations(const DistanceField& field, const Points& points,
                                 const Pose2& map_from_points, const Pose2& about, double kernel,
                                 FieldValues& values) {
  const auto squared_kernel = static_cast<float>(kernel * kernel);
  const auto x = static_cast<float>(about.x);
  const auto y = static_cast<float>(about.y);
  field.at(points, Transform(map_from_points), values);
  NormalEquations e;
  // A sum for each number, in the order of the points, and no branch: half of them may be out of reach.
  std::array<std::array<float, 3>, 3> h{};
  std::array<float, 3> g{};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float distance = values.distance[i];
    const float dx = values.dx[i];
    const float dy = values.dy[i];
    const bool tells = dx != 0.0F || dy != 0.0F;
    const float share = squared_kernel / (squared_kernel + distance * distance);
    const float weight = tells ? share * share : 0.0F;  // Geman-McClure
    const float turn = dy * (values.x[i] - x) - dx * (values.y[i] - y);
    const std::array<float, 3> j = {dx, dy, tells ? turn : 0.0F};
    for (std::size_t row = 0; row < 3; ++row) {
      for (std::size_t column = 0; column < 3; ++column) h[row][column] += weight * j[row] * j[column];
      g[row] += weight * distance * j[row];
    }
    e.weights += weight;
    e.squares += weight * distance * distance;
  }
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      e.h(row, column) = h[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
    e.g[row] = g[static_cast<std::size_t>(row)];
  }
  return e;
}

}  // namespace

Pose2 refined_pose(const DistanceField& field, const Points& points, const Pose2& map_from_points,
                   const PoseRefinement& refinement) {
  constexpr double settled = 1e-3;  // m, rad; a hundredth of what counts as contact
  if (points.empty()) return map_from_points;
  // About the middle of the points, so that a turn moves none of them far: their origin may be anywhere.
  const Vector3 middle = centroid(points);
  const Pose2 points_from_middle{middle.x(), middle.y(), 0.0};
  const Pose2 middle_from_points = inverse(points_from_middle);
  Pose2 pose = map_from_points * points_from_middle;
  FieldValues values;
  for (int iteration = 0; iteration < refinement.iterations; ++iteration) {
    NormalEquations e =
        normal_equations(field, points, pose * middle_from_points, pose, refinement.kernel, values);
    constexpr float damping = 1e-3F;
    e.h.diagonal() *= 1.0F + damping;
    const Eigen::LDLT<Eigen::Matrix3f> solver(e.h);
    const Eigen::Vector3f step = solver.solve(-e.g);
    if (!step.allFinite() || step.norm() > 1.0F) return map_from_points;
    pose = {pose.x + step.x(), pose.y + step.y(), wrap_angle(pose.theta + step.z())};
    if (std::abs(step.x()) < settled && std::abs(step.y()) < settled && std::abs(step.z()) < settled) break;
  }
  return pose * middle_from_points;
}

PoseCovariance pose_covariance(const DistanceField& field, const Points& points, const Pose2& map_from_points,
                               const Pose2& map_from_robot, double kernel) {
  // Chosen by the errors of right declarations (docs/tried.md).
  constexpr double least_deviation = 0.01;   // m; of a point, whatever its residual
  constexpr double correlated_points = 8.0;  // so many err alike, and count as one
  constexpr double drift = radians(0.2);
  FieldValues values;
  const NormalEquations e = normal_equations(field, points, map_from_points, map_from_robot, kernel, values);
  const double least = least_deviation * least_deviation;
  const double variance = e.weights > 0.0F ? std::max(least, double{e.squares / e.weights}) : least;
  Eigen::Matrix3d information = e.h.cast<double>() / (variance * correlated_points);
  information.diagonal() += Eigen::Vector3d(1.0, 1.0, 4.0);  // a metre and half a radian
  Eigen::Matrix3d c = information.inverse();
  c(2, 2) += drift * drift;
  return {.xx = c(0, 0), .xy = c(0, 1), .xt = c(0, 2), .yy = c(1, 1), .yt = c(1, 2), .tt = c(2, 2)};
}

void describe(ParamVisitor& v, PoseRefinement& p) {
  v.field("iterations", p.iterations, {.doc = "Gauss-Newton iterations at most.", .min = 0, .max = 1000});
}

}  // namespace glocal
