#include "matchers/iransac/shape_context.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "glocal/parallel.hpp"
#include "matchers/common/squares.hpp"

namespace glocal::iransac {
namespace {

constexpr auto pi = static_cast<float>(std::numbers::pi);

/// Two neighbouring cells, and the share of the second.
struct Between {
  int low;
  int high;
  float share_of_high;
};

/// Where a position in cells lies between the cells' middles; beyond the first and the last middle, all
/// belongs to these.
Between between(float position, int cells) {
  const float from_middle = std::clamp(position - 0.5F, 0.0F, static_cast<float>(cells - 1));
  const int low = std::min(static_cast<int>(from_middle), std::max(0, cells - 2));
  return {low, std::min(low + 1, cells - 1), from_middle - static_cast<float>(low)};
}

/// Adds to the bins of one feature, in which directions are the map's until they are turned.
class Histogram {
 public:
  Histogram(const ShapeContextRule& rule, float* bins)
      : rule_(rule),
        rings_per_log_(static_cast<float>((rule.rings - 1) / std::log(rule.radius / rule.nearest))),
        sectors_per_radian_(static_cast<float>(rule.sectors) / pi),
        bins_(bins) {}

  /// A point so far away (m), at most a quarter turn from the normal, with a direction.
  void add(float distance, float bearing, const std::array<float, 2>& direction) {
    const auto nearest = static_cast<float>(rule_.nearest);
    const float ring_of = distance <= nearest ? 0.0F : std::log(distance / nearest) * rings_per_log_ + 0.5F;
    const Between ring = between(ring_of, rule_.rings);
    const Between sector = between((bearing + pi / 2.0F) * sectors_per_radian_, rule_.sectors);
    add_to(ring.low, sector.low, (1.0F - ring.share_of_high) * (1.0F - sector.share_of_high), direction);
    add_to(ring.low, sector.high, (1.0F - ring.share_of_high) * sector.share_of_high, direction);
    add_to(ring.high, sector.low, ring.share_of_high * (1.0F - sector.share_of_high), direction);
    add_to(ring.high, sector.high, ring.share_of_high * sector.share_of_high, direction);
  }

  /// Directions relative to the normal's (doubled angles), square roots of lengths, and all to length 1.
  void normalise(const std::array<float, 2>& normal) {
    const int n = 2 * rule_.rings * rule_.sectors;
    float sum = 0.0F;
    for (int i = 0; i < n; i += 2) sum += std::hypot(bins_[i], bins_[i + 1]);
    if (sum == 0.0F) return;
    for (int i = 0; i < n; i += 2) {
      const float x = bins_[i];
      const float y = bins_[i + 1];
      const float length = std::hypot(x, y);
      if (length == 0.0F) continue;
      const float scale = 1.0F / std::sqrt(length * sum);
      bins_[i] = scale * (normal[0] * x + normal[1] * y);
      bins_[i + 1] = scale * (normal[0] * y - normal[1] * x);
    }
  }

 private:
  void add_to(int ring, int sector, float share, const std::array<float, 2>& direction) {
    float* bin = bins_ + std::ptrdiff_t{2} * (ring * rule_.sectors + sector);
    bin[0] += share * direction[0];
    bin[1] += share * direction[1];
  }

  const ShapeContextRule& rule_;
  float rings_per_log_, sectors_per_radian_;
  float* bins_;
};

/// Eight sums side by side, which the compiler turns into vectors.
template <class Term>
float sum_over(std::size_t n, Term term) {
  constexpr std::size_t lanes = 8;
  std::array<float, lanes> sums{};
  std::size_t i = 0;
  for (; i + lanes <= n; i += lanes) {
    for (std::size_t k = 0; k < lanes; ++k) sums[k] += term(i + k);
  }
  for (; i < n; ++i) sums[0] += term(i);
  float sum = 0.0F;
  for (const float part : sums) sum += part;
  return sum;
}

}  // namespace

float dot(const float* a, const float* b, std::size_t dimensions) {
  return sum_over(dimensions, [&](std::size_t i) { return a[i] * b[i]; });
}

float squared_distance(const float* a, const float* b, std::size_t dimensions) {
  return sum_over(dimensions, [&](std::size_t i) { return (a[i] - b[i]) * (a[i] - b[i]); });
}

FeatureVectors shape_contexts(const OrientedPoints& oriented_points, const std::vector<std::uint32_t>& of,
                              const ShapeContextRule& rule, int threads) {
  FeatureVectors result;
  result.dimensions = 2 * static_cast<std::size_t>(rule.rings) * static_cast<std::size_t>(rule.sectors);
  result.values.resize(of.size() * result.dimensions);
  // A surface has the same direction seen from its back: angles are doubled.
  std::vector<std::array<float, 2>> directions;
  for (const float angle : oriented_points.angle) {
    directions.push_back({std::cos(2.0F * angle), std::sin(2.0F * angle)});
  }
  const Squares squares(oriented_points.x, oriented_points.y, rule.radius);
  parallel_for(threads, of.size(), [&](std::size_t i) {
    const std::uint32_t at = of[i];
    const float normal_x = std::cos(oriented_points.angle[at]);
    const float normal_y = std::sin(oriented_points.angle[at]);
    const auto radius = static_cast<float>(rule.radius);
    Histogram histogram(rule, &result.values[i * result.dimensions]);
    squares.near(oriented_points.x[at], oriented_points.y[at], [&](std::uint32_t other) {
      const float dx = oriented_points.x[other] - oriented_points.x[at];
      const float dy = oriented_points.y[other] - oriented_points.y[at];
      const float along = normal_x * dx + normal_y * dy;
      const float across = normal_x * dy - normal_y * dx;
      const float distance = std::sqrt(dx * dx + dy * dy);
      if (distance == 0.0F || distance > radius || along < 0.0F) return;
      const bool faces =
          std::cos(oriented_points.angle[other]) * dx + std::sin(oriented_points.angle[other]) * dy < 0.0F;
      if (faces) histogram.add(distance, std::atan2(across, along), directions[other]);
    });
    histogram.normalise(directions[at]);
  });
  return result;
}

}  // namespace glocal::iransac
