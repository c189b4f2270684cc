#include "glocal/distance_field.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "glocal/error.hpp"

namespace glocal {

DistanceField::DistanceField(const Points& points, double resolution, double reach)
    : scale_(static_cast<float>(1.0 / resolution)), reach_(static_cast<float>(reach)) {
  const auto [min_x, max_x] = std::minmax_element(points.x.begin(), points.x.end());
  const auto [min_y, max_y] = std::minmax_element(points.y.begin(), points.y.end());
  min_x_ = *min_x - reach_;
  min_y_ = *min_y - reach_;
  const double columns = std::ceil((double{*max_x} - *min_x + 2.0 * reach) / resolution) + 2.0;
  const double rows = std::ceil((double{*max_y} - *min_y + 2.0 * reach) / resolution) + 2.0;
  constexpr double most_cells = 268435456.0;  // 1 GiB
  if (columns * rows > most_cells) {
    throw ConfigError(
        {{"", 0, 0,
          "the map is too large for a distance field: it would need more than 1 GiB; cut the map, or take "
          "a larger field_cell"}});
  }
  columns_ = static_cast<int>(columns);
  rows_ = static_cast<int>(rows);
  cells_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), reach_);

  const int around = static_cast<int>(std::ceil(reach / resolution));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float x = (points.x[i] - min_x_) * scale_;
    const float y = (points.y[i] - min_y_) * scale_;
    const int column = static_cast<int>(std::lround(x));
    const int row = static_cast<int>(std::lround(y));
    for (int r = std::max(0, row - around); r <= std::min(rows_ - 1, row + around); ++r) {
      for (int c = std::max(0, column - around); c <= std::min(columns_ - 1, column + around); ++c) {
        const float dx = static_cast<float>(c) - x;
        const float dy = static_cast<float>(r) - y;
        float& cell = cells_[index(c, r)];
        cell = std::min(cell, std::sqrt(dx * dx + dy * dy) / scale_);
      }
    }
  }
}

std::shared_ptr<const DistanceField> distance_field(const GlobalMap& map, double cell) {
  return map.index<DistanceField>(fmt::format("{}", cell), [&] { return DistanceField(map.points(), cell); });
}

namespace {

/// Of the sum of weighted squared distances, about a pose that is turned around `about`.
struct NormalEquations {
  Eigen::Matrix3f h = Eigen::Matrix3f::Zero();
  Eigen::Vector3f g = Eigen::Vector3f::Zero();
  float weights = 0.0F;
  float squares = 0.0F;  ///< m^2
};

NormalEquations normal_equations(const DistanceField& field, const Points& points,
                                 const Pose2& map_from_points, const Pose2& about, double kernel) {
  const auto squared_kernel = static_cast<float>(kernel * kernel);
  const auto x = static_cast<float>(about.x);
  const auto y = static_cast<float>(about.y);
  const Transform transform(map_from_points);
  NormalEquations e;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point p = transform(points[i]);
    const DistanceField::Value value = field.at(p.x, p.y);
    if (value.dx == 0.0F && value.dy == 0.0F) continue;
    const float share = squared_kernel / (squared_kernel + value.distance * value.distance);
    const float weight = share * share;  // Geman-McClure
    const Eigen::Vector3f j(value.dx, value.dy, value.dy * (p.x - x) - value.dx * (p.y - y));
    e.h += weight * j * j.transpose();
    e.g += weight * value.distance * j;
    e.weights += weight;
    e.squares += weight * value.distance * value.distance;
  }
  return e;
}

}  // namespace

Pose2 refined_pose(const DistanceField& field, const Points& points, const Pose2& map_from_points,
                   const PoseRefinement& refinement) {
  constexpr double settled = 1e-3;  // m, rad; a hundredth of what counts as contact
  Pose2 pose = map_from_points;
  for (int iteration = 0; iteration < refinement.iterations; ++iteration) {
    NormalEquations e = normal_equations(field, points, pose, pose, refinement.kernel);
    constexpr float damping = 1e-3F;
    e.h.diagonal() *= 1.0F + damping;
    const Eigen::LDLT<Eigen::Matrix3f> solver(e.h);
    const Eigen::Vector3f step = solver.solve(-e.g);
    if (!step.allFinite() || step.norm() > 1.0F) return map_from_points;
    pose = {pose.x + step.x(), pose.y + step.y(), wrap_angle(pose.theta + step.z())};
    if (std::abs(step.x()) < settled && std::abs(step.y()) < settled && std::abs(step.z()) < settled) break;
  }
  return pose;
}

PoseCovariance pose_covariance(const DistanceField& field, const Points& points, const Pose2& map_from_points,
                               const Pose2& map_from_robot, double kernel,
                               const PoseUncertainty& uncertainty) {
  const NormalEquations e = normal_equations(field, points, map_from_points, map_from_robot, kernel);
  const double least = uncertainty.point_deviation * uncertainty.point_deviation;
  const double variance = e.weights > 0.0F ? std::max(least, double{e.squares / e.weights}) : least;
  Eigen::Matrix3d information = e.h.cast<double>() / (variance * uncertainty.correlated_points);
  information.diagonal() += Eigen::Vector3d(1.0, 1.0, 4.0);  // a metre and half a radian
  Eigen::Matrix3d c = information.inverse();
  const double drift = uncertainty.drift * uncertainty.drift;
  const double turn = radians(uncertainty.drift_deg) * radians(uncertainty.drift_deg);
  c.diagonal() += Eigen::Vector3d(drift, drift, turn);
  return {.xx = c(0, 0), .xy = c(0, 1), .xt = c(0, 2), .yy = c(1, 1), .yt = c(1, 2), .tt = c(2, 2)};
}

void describe_field_cell(ParamVisitor& v, double& cell) {
  v.field("field_cell", cell,
          {.doc = "Side of a cell of the distance field.",
           .unit = "m",
           .min = 0.01,
           .max = 1.0,
           .audience = Audience::expert});
}

void describe(ParamVisitor& v, PoseRefinement& p) {
  v.field("iterations", p.iterations, {.doc = "Gauss-Newton iterations at most.", .min = 0, .max = 1000});
  v.field("kernel", p.kernel,
          {.doc = "Points at this distance from the map count a quarter (Geman-McClure).",
           .unit = "m",
           .above = 0.0});
}

void describe(ParamVisitor& v, PoseUncertainty& p) {
  v.field("point_deviation", p.point_deviation,
          {.doc = "Deviation of a point from the map, at least.", .unit = "m", .above = 0.0});
  v.field("correlated_points", p.correlated_points,
          {.doc = "Number of neighbouring points that err alike, and so count as one.", .min = 1.0});
  v.field("drift", p.drift, {.doc = "Deviation of the robot in its local map.", .unit = "m", .min = 0.0});
  v.field("drift_deg", p.drift_deg,
          {.doc = "Deviation of the robot's heading in its local map.", .unit = "deg", .min = 0.0});
}

}  // namespace glocal
