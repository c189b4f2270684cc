// Points as they are written down or drawn, and maps of nothing else.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "glocal/global_map.hpp"
#include "glocal/points.hpp"
#include "glocal/rng.hpp"

namespace glocal::test {

inline Points points_of(const std::vector<Point>& written) {
  Points points;
  for (const Point& point : written) points.push_back(point);
  return points;
}

/// Of the plane.
inline Points points_at(const std::vector<std::pair<float, float>>& metres) {
  Points points;
  for (const auto& [x, y] : metres) points.push_back({x, y, 0.0F});
  return points;
}

/// Anywhere in a rectangle with a corner at the origin.
inline Points random_points(Rng& rng, std::size_t n, double width, double height) {
  Points points;
  for (std::size_t i = 0; i < n; ++i) {
    points.push_back(
        {static_cast<float>(rng.uniform(0.0, width)), static_cast<float>(rng.uniform(0.0, height)), 0.0F});
  }
  return points;
}

/// A map without a grid.
inline std::shared_ptr<const GlobalMap> map_of(Points points) {
  MapData data;
  data.points = std::move(points);
  return std::make_shared<const GlobalMap>(std::move(data));
}

}  // namespace glocal::test
