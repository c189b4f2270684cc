// Points of a local map in space, with the directions of the surfaces they lie on.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "glocal/local_map.hpp"
#include "glocal/params.hpp"
#include "glocal/points.hpp"
#include "glocal/voxel_numbers.hpp"

namespace glocal::local_mappers {

struct SurfaceMapParams {
  double resolution = 0.15;
  int cell_hits = 20;  ///< The point of a cube is the mean of its first hits, so many. Not in YAML.
  double normal_radius = 0.6;
};
void describe(ParamVisitor& v, SurfaceMapParams& p);

/// A local map downsampled to cubes of `resolution`; a cube's point is the mean of its first `cell_hits`
/// hits. A normal is the direction in which the points within `normal_radius` spread least, where they lie in
/// a plane; it is turned to where the point was seen from. Points are looked up in blocks with the side
/// normal_radius.
class SurfaceMap {
 public:
  /// Hits farther than this from the origin of the local frame (m) are left out: single precision ends there.
  static constexpr double reach = 4000.0;

  explicit SurfaceMap(const SurfaceMapParams& params);

  [[nodiscard]] const LocalMap& map() const { return map_; }
  void move_robot(const Pose3& local_from_robot) { map_.local_from_robot = local_from_robot; }
  /// Registers the next observation's hits (local frame; perhaps none), seen from `sensor`. `way`: driven
  /// up to here, m.
  void add(const Points& hits, const Point& sensor, double way);
  /// Drops the points that were last hit by one but the last `scans` observations, or before `way`. Their
  /// order stays. Observations of which nothing is left are forgotten, from the oldest on.
  void forget(std::size_t scans, double way);
  /// Begins the next epoch, without points.
  void start_over();
  /// Begins the first one.
  void reset();

  /// The nearest point within a distance (m); the earlier of two equally near ones.
  [[nodiscard]] std::optional<std::size_t> nearest(const Point& p, double within) const;

 private:
  struct Seen {
    std::uint32_t hits = 0;
    std::size_t last = 0;  ///< Observation, counted from the beginning of the map.
    double way = 0.0;      ///< m
  };
  using Cell = std::array<std::int32_t, 3>;
  using BlockNumbers = VoxelNumbers<std::int32_t>;
  using Block = BlockNumbers::Voxel;

  [[nodiscard]] Cell cell_of(const Point& p) const;
  [[nodiscard]] Block block_of(const Cell& cell) const;
  /// The point that has the hit's cell now.
  std::size_t add_hit(const Point& p);
  void index_point(std::size_t index);
  void rebuild_index();
  void update_normals(const std::vector<std::size_t>& points, const Point& sensor);
  /// All points in the blocks at and around a point's.
  [[nodiscard]] Points points_around(std::uint32_t index) const;
  [[nodiscard]] Point normal_at(const Point& p, const Points& around) const;

  SurfaceMapParams params_;
  std::int32_t cells_in_block_;
  float block_side_;
  LocalMap map_;
  std::vector<Seen> seen_;
  BlockNumbers numbers_;
  std::vector<std::vector<std::uint32_t>> blocks_;  ///< The points of each block, by its number.
  std::size_t observations_ = 0;
};

}  // namespace glocal::local_mappers
