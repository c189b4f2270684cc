// A small world that several tests share: an L-shaped room with a niche, which looks like itself in one pose
// only.
#pragma once

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "glocal/global_map.hpp"
#include "glocal/local_map.hpp"
#include "glocal/points.hpp"
#include "glocal/rng.hpp"

namespace glocal::test {

/// Points every 5 cm along a polyline, m.
inline void add_wall(Points& points, const std::vector<std::pair<double, double>>& corners) {
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const auto [x0, y0] = corners[i - 1];
    const auto [x1, y1] = corners[i];
    const int n = static_cast<int>(std::lround(std::hypot(x1 - x0, y1 - y0) / 0.05));
    for (int k = 0; k < n; ++k) {
      const double t = static_cast<double>(k) / n;
      points.push_back(
          {static_cast<float>(x0 + t * (x1 - x0)), static_cast<float>(y0 + t * (y1 - y0)), 0.0F});
    }
  }
}

inline Points small_world_points() {
  Points points;
  add_wall(points,
           {{0, 0}, {8, 0}, {8, 3}, {7, 3}, {7, 3.6}, {8, 3.6}, {8, 5}, {4, 5}, {4, 9}, {0, 9}, {0, 0}});
  return points;
}

/// The world with a grid of 0.1 m whose cells are all free.
inline std::shared_ptr<const GlobalMap> small_world() {
  MapData data;
  data.points = small_world_points();
  data.grid = {{-0.05, -0.05, 0.0}, 0.1, 82, 92, PackedCells(std::size_t{82} * 92, Cell::free)};
  return std::make_shared<const GlobalMap>(std::move(data));
}

/// Points moved into another frame.
inline Points moved(const Points& points, const Pose2& target_from_source) {
  const Transform transform(target_from_source);
  Points result;
  for (std::size_t i = 0; i < points.size(); ++i) result.push_back(transform(points[i]));
  return result;
}

/// The part of the world within `reach` of a robot, in the robot's frame.
inline Points seen_from(const Points& world, const Pose2& map_from_robot, double reach) {
  const Points local = moved(world, inverse(map_from_robot));
  Points result;
  for (std::size_t i = 0; i < local.size(); ++i) {
    if (std::hypot(local.x[i], local.y[i]) <= reach) result.push_back(local[i]);
  }
  return result;
}

/// Somewhere in one of the small world's two rooms: in the lower one for even numbers, in the upper one for
/// odd ones.
inline Pose2 somewhere_in_small_world(int number, Rng& rng) {
  const bool lower = number % 2 == 0;
  return {rng.uniform(1.0, lower ? 7.0 : 3.0), lower ? rng.uniform(1.0, 4.0) : rng.uniform(5.0, 8.0),
          rng.uniform(-3.14, 3.14)};
}

/// The local map of a robot that stands in the small world and sees so far; it begins where the robot is.
inline LocalMap local_map_at(const Pose2& map_from_robot, double reach) {
  LocalMap local;
  local.points = seen_from(small_world_points(), map_from_robot, reach);
  local.ends = {local.points.size()};
  return local;
}

}  // namespace glocal::test
