#include "report/map_points.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>

#include "report/millimetres.hpp"
#include "report/numbers.hpp"
#include "report/thinning.hpp"

namespace glocal {
namespace {

/// A screen shows no more of a building at once, and a browser turns them without a hitch.
constexpr std::size_t most_in_space = 150'000;

/// Square of the distance to the nearest other point, mm².
std::int64_t nearest_squared(const std::vector<GridPoint>& points, std::size_t which) {
  const auto squared = [](std::int64_t d) { return d * d; };
  std::int64_t nearest = std::numeric_limits<std::int64_t>::max();
  // They ascend in x: farther on this side than the nearest so far is none nearer.
  const auto look = [&](std::size_t i) {
    const std::int64_t dx = squared(std::int64_t{points[i].x} - points[which].x);
    if (dx >= nearest) return false;
    nearest = std::min(nearest, dx + squared(std::int64_t{points[i].y} - points[which].y) +
                                    squared(std::int64_t{points[i].z} - points[which].z));
    return true;
  };
  for (std::size_t i = which + 1; i < points.size() && look(i); ++i) {
  }
  for (std::size_t i = which; i > 0 && look(i - 1); --i) {
  }
  return nearest;
}

/// Median distance to the nearest other point, m; of some hundred points all over the map.
double spacing_of(const std::vector<GridPoint>& points) {
  if (points.size() < 2) return 0.0;
  const std::size_t stride = 1 + points.size() / 512;
  std::vector<std::int64_t> squared;
  for (std::size_t i = 0; i < points.size(); i += stride) squared.push_back(nearest_squared(points, i));
  const auto middle = squared.begin() + static_cast<std::ptrdiff_t>(squared.size() / 2);
  std::nth_element(squared.begin(), middle, squared.end());
  return std::sqrt(static_cast<double>(*middle)) / 1000.0;
}

}  // namespace

nlohmann::ordered_json map_points(const Points& points, const Vector3& origin) {
  std::vector<GridPoint> grid_points = in_millimetres(thinned_in_space(points, most_in_space));
  std::sort(grid_points.begin(), grid_points.end());
  grid_points.erase(std::unique(grid_points.begin(), grid_points.end()), grid_points.end());
  const auto in_map = [](int millimetres, double metres) {
    return std::llround(1000.0 * metres) + millimetres;
  };
  std::vector<std::int64_t> x, y, z;
  for (const GridPoint& point : grid_points) {
    x.push_back(in_map(point.x, origin.x()));
    y.push_back(in_map(point.y, origin.y()));
    z.push_back(in_map(point.z, origin.z()));
  }
  nlohmann::ordered_json json = {{"x", x}, {"y", y}, {"spacing_m", short_number(spacing_of(grid_points))}};
  if (has_heights(z)) json["z"] = z;
  return json;
}

}  // namespace glocal
