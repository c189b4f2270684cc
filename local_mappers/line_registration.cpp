#include "local_mappers/line_registration.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace glocal::local_mappers {

namespace {

/// Scale of the kernel, as a share of the match distance: what is as far away has a hundredth of a near hit's
/// weight.
constexpr double kernel_share = 0.333;
/// Between the normals of a hit and its point of the map: farther turned it is another side of the thing.
constexpr double max_normal_angle_deg = 60.0;
/// Of matches without normals, which count point to point; others have weight 1.
constexpr double pointwise_weight = 0.2;
/// Added to the diagonal of the normal equations per match: keeps directions still that no match sees.
constexpr double damping = 1e-4;
constexpr int max_steps = 20;
constexpr double converged_m = 1e-4;
constexpr double converged_rad = 1e-4;

/// The normal equations in plain doubles, which the compiler keeps in registers.
class NormalSums {
 public:
  explicit NormalSums(double kernel) : kernel_squared_(kernel * kernel) {}

  /// One residual (m) with its derivative by x, y and theta.
  void add(double residual, double dx, double dy, double dtheta, double weight) {
    const double squared = residual * residual;
    const double share = kernel_squared_ / (kernel_squared_ + squared);
    const double w = weight * share * share;
    cost_ += 0.5 * weight * share * squared;
    xx_ += w * dx * dx;
    xy_ += w * dx * dy;
    xt_ += w * dx * dtheta;
    yy_ += w * dy * dy;
    yt_ += w * dy * dtheta;
    tt_ += w * dtheta * dtheta;
    const double wr = w * residual;
    gx_ += wr * dx;
    gy_ += wr * dy;
    gt_ += wr * dtheta;
  }

  [[nodiscard]] NormalEquations equations(int matches) const {
    NormalEquations e;
    e.hessian << xx_, xy_, xt_, xy_, yy_, yt_, xt_, yt_, tt_;
    e.gradient << gx_, gy_, gt_;
    e.cost = cost_;
    e.matches = matches;
    return e;
  }

 private:
  double kernel_squared_;
  double xx_ = 0.0, xy_ = 0.0, xt_ = 0.0, yy_ = 0.0, yt_ = 0.0, tt_ = 0.0;
  double gx_ = 0.0, gy_ = 0.0, gt_ = 0.0;
  double cost_ = 0.0;
};

}  // namespace

void describe(ParamVisitor& v, LineRegistrationParams& p) {
  v.field("gate", p.match_distance,
          {.doc = "Farthest a hit may be from its point of the map; at most 11 cells.",
           .unit = "m",
           .above = 0.0});
}

NormalEquations linearise(const PointGrid& grid, const LocalMap& map, const Points& hits,
                          const Points& normals, const Pose2& local_from_robot, double match_distance) {
  const Transform transform(local_from_robot);
  const Transform rotation({0.0, 0.0, local_from_robot.theta});
  const Point robot = transform({});
  const auto match_distance_squared = static_cast<float>(match_distance * match_distance);
  const auto min_cosine = static_cast<float>(std::cos(radians(max_normal_angle_deg)));
  NormalSums sums(match_distance * kernel_share);
  int matches = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const Point p = transform(hits[i]);
    const int found = grid.nearest(p.x, p.y);
    if (found == PointGrid::none) continue;
    const auto j = static_cast<std::size_t>(found);
    const float dx = p.x - map.points.x[j];
    const float dy = p.y - map.points.y[j];
    if (dx * dx + dy * dy > match_distance_squared) continue;
    // Turning the robot moves a hit at right angles to its ray.
    const float lever_x = robot.y - p.y;
    const float lever_y = p.x - robot.x;
    const float nx = map.normals.x[j];
    const float ny = map.normals.y[j];
    const Point normal = rotation(normals[i]);
    const bool has_normals = (nx != 0.0F || ny != 0.0F) && (normal.x != 0.0F || normal.y != 0.0F);
    if (!has_normals) {
      sums.add(dx, 1.0, 0.0, lever_x, pointwise_weight);
      sums.add(dy, 0.0, 1.0, lever_y, pointwise_weight);
    } else if (nx * normal.x + ny * normal.y >= min_cosine) {
      sums.add(nx * dx + ny * dy, nx, ny, nx * lever_x + ny * lever_y, 1.0);
    } else {
      continue;
    }
    ++matches;
  }
  return sums.equations(matches);
}

ScanRegistration register_scan(const PointGrid& grid, const LocalMap& map, const Points& hits,
                               const Points& normals, const Pose2& start, double match_distance) {
  ScanRegistration result{start, 0};
  for (int iteration = 0; iteration < max_steps; ++iteration) {
    NormalEquations equations = linearise(grid, map, hits, normals, result.local_from_robot, match_distance);
    result.matches = equations.matches;
    if (equations.matches == 0) break;
    equations.hessian.diagonal().array() += damping * equations.matches;
    const Eigen::Vector3d step = -equations.hessian.ldlt().solve(equations.gradient);
    Pose2& pose = result.local_from_robot;
    pose = {pose.x + step.x(), pose.y + step.y(), wrap_angle(pose.theta + step.z())};
    if (std::hypot(step.x(), step.y()) < converged_m && std::abs(step.z()) < converged_rad) break;
  }
  return result;
}

}  // namespace glocal::local_mappers
