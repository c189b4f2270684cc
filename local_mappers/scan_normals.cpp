#include "local_mappers/scan_normals.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace glocal::local_mappers {

namespace {

/// Farthest two successive hits of one surface may be apart, m: a beam's spacing on a wall seen at a flat
/// angle.
constexpr float max_gap = 0.6F;

/// Neighbours of a hit that lie on the same surface, as far as jumps between beams can tell: [first, last].
struct Window {
  std::size_t first;
  std::size_t last;
};

/// For each hit, how many hits before it follow one another without a jump.
std::vector<int> unbroken_before(const Points& hits) {
  std::vector<int> counts(hits.size(), 0);
  for (std::size_t i = 1; i < hits.size(); ++i) {
    const float dx = hits.x[i] - hits.x[i - 1];
    const float dy = hits.y[i] - hits.y[i - 1];
    if (dx * dx + dy * dy <= max_gap * max_gap) counts[i] = counts[i - 1] + 1;
  }
  return counts;
}

/// The normal of a line through hits[window], or (0, 0, 0) if they do not lie on one.
Point line_normal(const Points& hits, std::size_t centre, Window window, float max_roughness) {
  // Relative to the centre, so that single precision is enough far from the origin.
  float sx = 0.0F, sy = 0.0F, sxx = 0.0F, sxy = 0.0F, syy = 0.0F;
  for (std::size_t i = window.first; i <= window.last; ++i) {
    const float x = hits.x[i] - hits.x[centre];
    const float y = hits.y[i] - hits.y[centre];
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
    syy += y * y;
  }
  const float inverse_n = 1.0F / static_cast<float>(window.last - window.first + 1);
  const float xx = sxx - sx * sx * inverse_n;
  const float yy = syy - sy * sy * inverse_n;
  const float xy = sxy - sx * sy * inverse_n;
  const float difference = xx - yy;
  const float root = std::sqrt(difference * difference + 4.0F * xy * xy);
  // Eigenvalues are (xx + yy +- root) / 2; hits that coincide or scatter have no direction.
  if (root <= 0.0F || xx + yy - root > max_roughness * (xx + yy + root)) return {};
  // Major axis by the half-angle formulas, in the form that does not cancel.
  const float ax = difference >= 0.0F ? root + difference : 2.0F * xy;
  const float ay = difference >= 0.0F ? 2.0F * xy : root - difference;
  const float inverse_length = 1.0F / std::sqrt(ax * ax + ay * ay);
  return {-ay * inverse_length, ax * inverse_length, 0.0F};
}

}  // namespace

void describe(ParamVisitor& v, ScanNormalParams& p) {
  v.field("beams", p.beams,
          {.doc = "Neighbouring hits on each side that a normal is computed from.", .min = 1, .max = 100});
  v.field("max_roughness", p.max_roughness,
          {.doc = "Largest ratio of the variances across and along a line; rougher hits get no normal.",
           .max = 1.0,
           .above = 0.0});
}

Points scan_normals(const Points& hits, const Point& sensor, const ScanNormalParams& params) {
  const std::size_t n = hits.size();
  const std::vector<int> before = unbroken_before(hits);
  Points normals;
  normals.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    Window window{i - static_cast<std::size_t>(std::min(before[i], params.beams)), i};
    const std::size_t limit = std::min(n - 1, i + static_cast<std::size_t>(params.beams));
    while (window.last < limit && before[window.last + 1] > 0) ++window.last;
    // Two hits are always on a line: that says nothing.
    Point normal = window.last - window.first < 2
                       ? Point{}
                       : line_normal(hits, i, window, static_cast<float>(params.max_roughness));
    if (normal.x * (sensor.x - hits.x[i]) + normal.y * (sensor.y - hits.y[i]) < 0.0F) {
      normal = {-normal.x, -normal.y, 0.0F};
    }
    normals.push_back(normal);
  }
  return normals;
}

}  // namespace glocal::local_mappers
