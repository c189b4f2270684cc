// The known map, built once and shared read-only by all trials and threads.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <typeindex>
#include <utility>
#include <vector>

#include "glocal/free_voxels.hpp"
#include "glocal/motion.hpp"
#include "glocal/occupancy_grid.hpp"
#include "glocal/points.hpp"
#include "glocal/pose3.hpp"

namespace glocal {

/// One of several maps that lie side by side along x in a common frame, too far apart for one scan to reach
/// two of them.
struct MapPart {
  std::string name;
  Pose3 common_from_part;  ///< Of the frame that it would have if it were alone.
  double from_x = 0.0;     ///< m, in the common frame: where it begins, up to the next.
};

/// Where a robot is, said with the map that it is on.
struct MapPlace {
  std::string map;       ///< Empty where there is only one.
  Pose3 map_from_robot;  ///< In the frame of that map.
};

/// What a MapSource delivers. Where the map lies far from the origin of its frame, all places are held
/// relative to an `origin` near them, as single precision is coarse far away.
struct MapData {
  Points points;            ///< Occupied places, m. Never empty.
  Points normals;           ///< Unit normals of `points`, or empty.
  OccupancyGrid grid;       ///< Free, occupied and unknown cells.
  std::vector<Pose3> path;  ///< Robot poses the map was made from, in order; empty if not known.
  /// m; how far apart neighbouring points lie, of a map without cells; 0 if not known.
  double resolution = 0.0;
  /// Of a map of points in space: what it knows to be free there; empty if it knows of none.
  FreeVoxels free_voxels = {};
  /// m, in the map's frame: what is to be added to places of points, grid, path and voxels.
  Vector3 origin = Vector3::Zero();
  /// If these are several maps: all of them, in the order of their `from_x`.
  std::vector<MapPart> parts = {};
};

/// The origin of a map that has this place (m): along each axis 0 where that is up to 1 km, and beyond it the
/// place, in whole metres; in the plane without a height.
[[nodiscard]] Vector3 origin_near(const Vector3& place, Motion motion = Motion::planar);

/// The known map, immutable, with indexes that are built once for all who ask.
class GlobalMap {
 public:
  explicit GlobalMap(MapData data);

  [[nodiscard]] const MapData& data() const { return data_; }
  [[nodiscard]] const Points& points() const { return data_.points; }
  [[nodiscard]] const Points& normals() const { return data_.normals; }
  [[nodiscard]] const OccupancyGrid& grid() const { return data_.grid; }
  [[nodiscard]] const FreeVoxels& free_voxels() const { return data_.free_voxels; }
  [[nodiscard]] const std::vector<Pose3>& path() const { return data_.path; }
  [[nodiscard]] const Vector3& origin() const { return data_.origin; }
  /// A pose in the map's frame, relative to the origin as points, grid and path are.
  [[nodiscard]] Pose3 relative(const Pose3& map_from_robot) const {
    return shifted(map_from_robot, -data_.origin);
  }
  [[nodiscard]] const std::vector<MapPart>& parts() const { return data_.parts; }
  /// Which of the maps the pose (in the common frame) lies on, and where there.
  [[nodiscard]] MapPlace place_of(const Pose3& map_from_robot) const;
  /// m; the side of the grid's cells, or else as the source says; 0 if not known.
  [[nodiscard]] double resolution() const {
    return data_.grid.resolution > 0.0 ? data_.grid.resolution : data_.resolution;
  }

  /// An index of this map (contact grid, relation table, …) that is built by the first who asks and then
  /// shared. `key` tells apart indexes of one type built with different parameters. Thread-safe; `build`
  /// returns a T.
  template <class T, class Build>
  [[nodiscard]] std::shared_ptr<const T> index(const std::string& key, Build build) const {
    return std::static_pointer_cast<const T>(shared_index(
        typeid(T), key, [&]() -> std::shared_ptr<const void> { return std::make_shared<const T>(build()); }));
  }

 private:
  [[nodiscard]] std::shared_ptr<const void> shared_index(
      std::type_index type, const std::string& key,
      const std::function<std::shared_ptr<const void>()>& build) const;

  MapData data_;
  mutable std::mutex mutex_;
  mutable std::map<std::pair<std::type_index, std::string>, std::shared_ptr<const void>> indexes_;
};

}  // namespace glocal
