// Points with the direction in which the free side lies: what oriented point pairs are made of.
#pragma once

#include <cstddef>
#include <vector>

#include "glocal/global_map.hpp"
#include "glocal/local_map.hpp"

namespace glocal {

/// Points of the plane with the normals of the surfaces they lie on.
struct OrientedPoints {
  std::vector<float> x;      ///< m
  std::vector<float> y;      ///< m
  std::vector<float> angle;  ///< rad; of the unit normal that points to the free side.
  double share = 1.0;        ///< Of a map's downsampled points, those that have a normal.

  [[nodiscard]] std::size_t size() const { return x.size(); }
  void add(float px, float py, float normal_angle) {
    x.push_back(px);
    y.push_back(py);
    angle.push_back(normal_angle);
  }
};

struct OrientedPointRule {
  double voxel_size = 0.1;  ///< m; one point in each square of this side.
  double radius = 0.2;      ///< m; neighbours that give the normal.
  /// Standard deviation across the surface, as a share of that along it, from which there is no normal.
  double max_roughness = 0.4;
};

/// The map's: normals by principal components of what lies on one line with a point, turned to the free
/// cells; a wall that is free on both sides gives two points, one that is free on neither as well. Where a
/// wall's two sides are on the map, 0.15 m apart or more, each has its own normal. Of more than 3 million
/// squares an even share gives points.
[[nodiscard]] OrientedPoints oriented_points_of(const GlobalMap& map, const OrientedPointRule& rule,
                                                int threads = 1);

/// The local map's: where it has normals, those; they point to where the sensor was. Else by principal
/// components, in both directions.
[[nodiscard]] OrientedPoints oriented_points_of(const LocalMap& local, const OrientedPointRule& rule);

/// The middle of the points in each square of this side (m); z is 0.
[[nodiscard]] Points downsampled_in_plane(const Points& points, double side);

}  // namespace glocal
