// The points of a local map, one for each cell that was hit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "glocal/local_map.hpp"
#include "glocal/observation.hpp"
#include "glocal/params.hpp"
#include "local_mappers/point_grid.hpp"

namespace glocal::local_mappers {

/// How points are downsampled. Of any local mapper that does so the resolution is a parameter.
struct VoxelParams {
  double resolution = 0.05;
  int cell_hits = 3;    ///< The point of a voxel is the mean of its first hits, so many of them.
  int memory_mb = 256;  ///< That the index of the points may take. Not in YAML.
};
void describe(ParamVisitor& v, VoxelParams& p);

/// Cells of this side that cover so many metres.
[[nodiscard]] int cells_in(double metres, double resolution);

/// Hits of one observation in the local frame, with their normals.
struct LocalScan {
  Points hits;
  Points normals;  ///< Or none at all.

  /// Hits and normals in the robot's frame, seen from there.
  LocalScan(const Points& robot_hits, const Points& robot_normals, const Pose2& local_from_robot);
  /// Hits in the local frame, without normals.
  explicit LocalScan(Points local_hits) : hits(std::move(local_hits)) {}
  /// Nothing to be registered.
  LocalScan() = default;
};

/// A local map downsampled to voxels of `resolution` (cubes, for hits at different heights); a cell's point
/// is the mean of its first `cell_hits` hits. It has normals if scans have. Hits outside of what the grid can
/// hold (800 m from where the map began, with cells of 5 cm) or beyond `memory_mb` are left out.
class VoxelMap {
 public:
  /// `reach` (cells) and `sigma` (m) are the grid's.
  VoxelMap(const VoxelParams& params, int reach, double sigma);

  [[nodiscard]] const LocalMap& map() const { return map_; }
  /// Index of the points.
  [[nodiscard]] const PointGrid& grid() const { return grid_; }

  /// The map's local_from_robot, seen from above.
  [[nodiscard]] const Pose2& robot() const { return robot_; }
  void move_robot(const Pose2& local_from_robot);
  void move_robot(const Pose3& local_from_robot);
  /// Whether the grid can hold what lies where the robot is.
  [[nodiscard]] bool holds_robot() const;
  /// Registers the next observation's hits; perhaps none.
  void add(const LocalScan& scan);
  /// Forgets all observations, but neither frame nor robot.
  void clear();
  /// Begins the next epoch, with the robot at the origin.
  void start_over();
  /// Begins the first one.
  void reset();

 private:
  void add_hit(const Point& p, const Point* normal);
  /// The point of the map in this cell and at this height, or PointGrid::none.
  [[nodiscard]] int find_point(GridCell cell, float z) const;
  void append_point(GridCell cell, const Point& p, const Point* normal);
  void average_into(std::size_t index, const Point& p, const Point* normal);

  VoxelParams params_;
  PointGrid grid_;
  LocalMap map_;
  Pose2 robot_;                     ///< map_.local_from_robot, not rounded to a quaternion in the plane.
  std::vector<std::uint8_t> hits_;  ///< Hits averaged in each point so far.
  std::vector<std::int32_t> next_above_;  ///< Next point in the same column of the plane, or none.
};

}  // namespace glocal::local_mappers
