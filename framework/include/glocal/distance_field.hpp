// How far it is to the nearest point of a map, everywhere.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "glocal/global_map.hpp"
#include "glocal/params.hpp"
#include "glocal/points.hpp"
#include "glocal/pose2.hpp"
#include "glocal/pose_covariance.hpp"

namespace glocal {

/// The field at many places (m), as DistanceField::Value has it.
struct FieldValues {
  std::vector<float> x, y;
  std::vector<float> distance, dx, dy;
};
struct FieldView;

/// Distances in the plane from the centres of square cells to the nearest point, up to `reach`, and in
/// between by bilinear interpolation. A distance is kept as one of 256 steps up to the reach; cells come in
/// tiles, and those beyond the reach of all points take no memory.
class DistanceField {
 public:
  /// Throws ConfigError if it would need more than 1 GiB.
  explicit DistanceField(const Points& points, double resolution = 0.05, double reach = 0.5, int threads = 1);

  /// The field at a place.
  struct Value {
    float distance = 0.0F;  ///< m
    float dx = 0.0F;        ///< Its derivatives; 0 where the field is cut off.
    float dy = 0.0F;
  };
  [[nodiscard]] Value at(float x, float y) const;
  /// At all points once moved, in the time of a few: what `values` had is lost.
  void at(const Points& points, const Transform& map_from_points, FieldValues& values) const;
  [[nodiscard]] float reach() const { return reach_; }
  [[nodiscard]] std::size_t memory_bytes() const {
    return cells_.size() + tiles_.size() * sizeof(std::uint32_t);
  }

  /// Cells of a tile along either axis. It has those of its neighbours' first column and row, too.
  static constexpr int tile_shift = 4;
  static constexpr int tile_side = 1 << tile_shift;
  static constexpr int stride = tile_side + 1;
  static constexpr std::size_t tile_cells = static_cast<std::size_t>(stride) * stride;

 private:
  static constexpr std::uint8_t beyond_reach = 255;

  struct Place {
    float column, row;  ///< In cells; whole numbers are centres.
  };
  [[nodiscard]] Place place_of(float x, float y) const {
    return {(x - min_x_) * scale_, (y - min_y_) * scale_};
  }
  [[nodiscard]] std::size_t tile_of(int column, int row) const {
    return static_cast<std::size_t>(row >> tile_shift) * static_cast<std::size_t>(tile_columns_) +
           static_cast<std::size_t>(column >> tile_shift);
  }
  void place_tiles(const Points& points, int around);
  void fill(const Points& points, int around, int threads);
  void stamp(std::size_t tile, const Points& points, std::span<const std::uint32_t> near, int around);

  float min_x_ = 0.0F, min_y_ = 0.0F;  ///< Centre of cell (0, 0).
  float scale_ = 0.0F;                 ///< Cells per metre.
  float reach_ = 0.0F;
  float step_ = 0.0F;  ///< m
  int columns_ = 0, rows_ = 0;
  int tile_columns_ = 0, tile_rows_ = 0;
  std::vector<std::uint32_t> tiles_;  ///< Which of those in `cells_` it is; the first one is beyond reach.
  std::vector<std::uint8_t> cells_;   ///< And two more, as FieldView asks for.
};

inline DistanceField::Value DistanceField::at(float x, float y) const {
  const auto [u, v] = place_of(x, y);
  const auto last_column = static_cast<float>(columns_ - 1);
  const auto last_row = static_cast<float>(rows_ - 1);
  if (!(u >= 0.0F && v >= 0.0F && u < last_column && v < last_row)) return {reach_, 0.0F, 0.0F};
  const int column = static_cast<int>(u);
  const int row = static_cast<int>(v);
  const float a = u - static_cast<float>(column);
  const float b = v - static_cast<float>(row);
  constexpr int in_tile = tile_side - 1;
  const std::uint8_t* low = cells_.data() + tiles_[tile_of(column, row)] * tile_cells +
                            static_cast<std::size_t>((row & in_tile) * stride + (column & in_tile));
  const std::uint8_t* high = low + stride;
  const auto steps = [](int n) { return static_cast<float>(n); };
  const float below = steps(low[0]) + a * steps(low[1] - low[0]);
  const float above = steps(high[0]) + a * steps(high[1] - high[0]);
  const float dx = (1.0F - b) * steps(low[1] - low[0]) + b * steps(high[1] - high[0]);
  const float slope = step_ * scale_;
  return {step_ * (below + b * (above - below)), dx * slope, (above - below) * slope};
}

/// That of a map, with cells of 5 cm, 10 cm on maps of more than 25 hectares, shared by all who ask for it.
[[nodiscard]] std::shared_ptr<const DistanceField> distance_field(const GlobalMap& map, int threads);

/// How a pose is refined on the field.
struct PoseRefinement {
  int iterations = 12;
  double kernel = 0.15;  ///< m; points at this distance count a quarter (Geman-McClure).
};
void describe(ParamVisitor& v, PoseRefinement& p);

/// Moves a pose to where the points lie nearest to the field's, by Gauss-Newton with a robust kernel. Gives
/// up, and returns the pose it came with, where the points say nothing.
[[nodiscard]] Pose2 refined_pose(const DistanceField& field, const Points& points,
                                 const Pose2& map_from_points, const PoseRefinement& refinement);

/// Covariance of the robot's pose where a pose of the points is the refined one: the Gauss-Newton inverse
/// Hessian there, times the points' variance, as their residuals tell it, and what errors they have in
/// common, plus how far the robot's heading drifts in its local map. What the points leave open is taken to
/// be uncertain by a metre and half a radian.
[[nodiscard]] PoseCovariance pose_covariance(const DistanceField& field, const Points& points,
                                             const Pose2& map_from_points, const Pose2& map_from_robot,
                                             double kernel);

}  // namespace glocal
