#include "glocal/range_bias.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace glocal {
namespace {

/// Directions to each side of a wall's middle: 60 degrees in all. Wider walls are rare, narrower ones hardly
/// bulge.
constexpr std::size_t to_each_side = 15;
constexpr std::size_t rays_of_window = 2 * to_each_side + 1;
constexpr std::size_t least_seen = 28;
/// Directions from one middle to the next.
constexpr std::size_t step = 5;

/// How far points of a straight wall are from it, m: in the root of the mean square. What is less straight
/// mostly bulges by itself.
constexpr double most_off_wall = 0.015;
/// The same where the bulge is still there: no more than that of the largest bias that is looked for.
constexpr double most_off_bulge = 0.2;
/// Standard deviation of a bias that is worth counting, m.
constexpr double most_deviation = 0.1;
/// Points of a wall have at least this error, m.
constexpr double least_off_wall = 0.01;

/// A reading and the direction of its ray.
struct Ray {
  double range = 0.0;  ///< m
  double cos = 0.0, sin = 0.0;
};
using Rays = std::array<std::optional<Ray>, directions>;

Rays rays_of(const ReadingByDirection& readings) {
  Rays rays;
  for (std::size_t i = 0; i < directions; ++i) {
    if (readings[i] && readings[i]->range > 0.0)
      rays[i] = {readings[i]->range, std::cos(readings[i]->angle), std::sin(readings[i]->angle)};
  }
  return rays;
}

/// The rays of a window.
struct Seen {
  std::array<Ray, rays_of_window> rays;
  std::size_t size = 0;
  [[nodiscard]] std::span<const Ray> all() const { return {rays.data(), size}; }
};

Seen seen_around(const Rays& rays, std::size_t middle) {
  Seen seen;
  for (std::size_t k = 0; k < rays_of_window; ++k) {
    const auto& ray = rays[(middle + directions + k - to_each_side) % directions];
    if (ray) seen.rays[seen.size++] = *ray;
  }
  return seen;
}

/// A wall in polar coordinates: the range to it is bias + 1 / (a cos + b sin) of the angle.
struct Wall {
  double a = 0.0, b = 0.0, bias = 0.0;
};

/// The wall that fits if there is no bias: inverse ranges are linear in a and b.
Wall straight_wall(std::span<const Ray> seen) {
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (const Ray& ray : seen) {
    const Eigen::Vector2d row{ray.cos, ray.sin};
    squares += row * row.transpose();
    right += row / ray.range;
  }
  const Eigen::Vector2d solved = squares.ldlt().solve(right);
  return {solved.x(), solved.y(), 0.0};
}

struct Fit {
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  double off_wall = 0.0;  ///< m, root of the mean square.
};

/// How well the wall fits, across it, and in which direction a better one lies; none if it is no wall: some
/// rays do not meet it.
std::optional<Fit> fit_of(const Wall& wall, std::span<const Ray> seen) {
  Fit fit;
  double sum = 0.0;
  const double length = std::hypot(wall.a, wall.b);
  for (const Ray& ray : seen) {
    const double inverse = wall.a * ray.cos + wall.b * ray.sin;
    if (inverse <= 1e-3) return std::nullopt;
    const double across = inverse / length;  // Cosine of the angle at which the ray meets the wall.
    const double off = across * (ray.range - wall.bias - 1.0 / inverse);
    const Eigen::Vector3d row =
        across * Eigen::Vector3d{-ray.cos / (inverse * inverse), -ray.sin / (inverse * inverse), 1.0};
    fit.squares += row * row.transpose();
    fit.right += row * off;
    sum += off * off;
  }
  fit.off_wall = std::sqrt(sum / static_cast<double>(seen.size() - 3));
  return fit;
}

/// The bias that the wall around this direction tells, m; none if there is no straight wall.
std::optional<double> bias_of_wall(const Rays& rays, std::size_t middle) {
  const Seen seen = seen_around(rays, middle);
  if (seen.size < least_seen) return std::nullopt;
  Wall wall = straight_wall(seen.all());
  auto fit = fit_of(wall, seen.all());
  if (!fit || fit->off_wall > most_off_bulge) return std::nullopt;
  for (int iteration = 0; iteration < 5; ++iteration) {
    const Eigen::Vector3d better = fit->squares.ldlt().solve(fit->right);
    wall = {wall.a + better.x(), wall.b + better.y(), wall.bias + better.z()};
    fit = fit_of(wall, seen.all());
    if (!fit) return std::nullopt;
  }
  const double variance = fit->squares.inverse()(2, 2);
  const double deviation = std::max(fit->off_wall, least_off_wall) * std::sqrt(variance);
  if (!(fit->off_wall <= most_off_wall && deviation <= most_deviation)) return std::nullopt;
  // Somebody's round back, close by, is no wall at half the distance.
  const double away = 1.0 / std::hypot(wall.a, wall.b);
  if (std::abs(wall.bias) > away) return std::nullopt;
  return wall.bias;
}

}  // namespace

void RangeBias::take_in(const ReadingByDirection& readings) {
  const Rays rays = rays_of(readings);
  for (std::size_t middle = 0; middle < directions; middle += step) {
    const auto bias = bias_of_wall(rays, middle);
    if (!bias) continue;
    ++counts_[static_cast<std::size_t>(std::clamp((*bias + 1.0) / bin + 0.5, 0.0, bins - 0.5))];
    ++walls_;
  }
}

std::optional<double> RangeBias::median() const {
  if (walls_ == 0) return std::nullopt;
  std::size_t i = 0;
  for (std::size_t below = counts_[0]; 2 * below < walls_; below += counts_[i]) ++i;
  return static_cast<double>(i) * bin - 1.0;
}

}  // namespace glocal
