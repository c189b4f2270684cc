// How far it is to the nearest point of a map, everywhere.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "glocal/global_map.hpp"
#include "glocal/params.hpp"
#include "glocal/points.hpp"
#include "glocal/pose2.hpp"
#include "glocal/pose_covariance.hpp"

namespace glocal {

/// Distances in the plane from the centres of square cells to the nearest point, up to `reach`, and in
/// between by bilinear interpolation.
class DistanceField {
 public:
  /// Throws ConfigError if it would need more than 1 GiB.
  explicit DistanceField(const Points& points, double resolution = 0.05, double reach = 0.5);

  /// The field at a place.
  struct Value {
    float distance = 0.0F;  ///< m
    float dx = 0.0F;        ///< Its derivatives; 0 where the field is cut off.
    float dy = 0.0F;
  };
  [[nodiscard]] Value at(float x, float y) const;
  [[nodiscard]] float reach() const { return reach_; }
  [[nodiscard]] std::size_t memory_bytes() const { return cells_.size() * sizeof(float); }

 private:
  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }

  float min_x_ = 0.0F, min_y_ = 0.0F;  ///< Centre of cell (0, 0).
  float scale_ = 0.0F;                 ///< Cells per metre.
  float reach_ = 0.0F;
  int columns_ = 0, rows_ = 0;
  std::vector<float> cells_;
};

inline DistanceField::Value DistanceField::at(float x, float y) const {
  const float u = (x - min_x_) * scale_;
  const float v = (y - min_y_) * scale_;
  const auto last_column = static_cast<float>(columns_ - 1);
  const auto last_row = static_cast<float>(rows_ - 1);
  if (!(u >= 0.0F && v >= 0.0F && u < last_column && v < last_row)) return {reach_, 0.0F, 0.0F};
  const int column = static_cast<int>(u);
  const int row = static_cast<int>(v);
  const float a = u - static_cast<float>(column);
  const float b = v - static_cast<float>(row);
  const float* low = &cells_[index(column, row)];
  const float* high = low + columns_;
  const float below = low[0] + a * (low[1] - low[0]);
  const float above = high[0] + a * (high[1] - high[0]);
  const float dx = (1.0F - b) * (low[1] - low[0]) + b * (high[1] - high[0]);
  return {below + b * (above - below), dx * scale_, (above - below) * scale_};
}

/// That of a map, with cells of this side (m), shared by all who ask for it.
[[nodiscard]] std::shared_ptr<const DistanceField> distance_field(const GlobalMap& map, double cell);

/// The field `field_cell` (m) of a strategy that asks for one.
void describe_field_cell(ParamVisitor& v, double& cell);

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

/// What the covariance of a refined pose is made from.
struct PoseUncertainty {
  double point_deviation = 0.03;   ///< m; of a point from the map at least, whatever its residual.
  double correlated_points = 8.0;  ///< So many points err alike, and count as one.
  double drift = 0.02;             ///< m; of the robot in its local map.
  double drift_deg = 0.5;          ///< deg; the same of its heading.
};
void describe(ParamVisitor& v, PoseUncertainty& p);

/// Covariance of the robot's pose where a pose of the points is the refined one: the Gauss-Newton inverse
/// Hessian there, times the points' variance, plus the local map's drift. What the points leave open is
/// taken to be uncertain by a metre and half a radian.
[[nodiscard]] PoseCovariance pose_covariance(const DistanceField& field, const Points& points,
                                             const Pose2& map_from_points, const Pose2& map_from_robot,
                                             double kernel, const PoseUncertainty& uncertainty);

}  // namespace glocal
