#include "sources/clouds/cloud_drive_map.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "glocal/error.hpp"
#include "glocal/limits.hpp"
#include "glocal/voxel_numbers.hpp"

namespace glocal::clouds {
namespace {

/// What clouds have met in each cube of space, in the order in which cubes were met first.
class CubeSums {
 public:
  explicit CubeSums(double side) : side_(side) {}

  /// The next cloud, in the map's frame.
  void add(const Points& points) {
    ++clouds_;
    for (std::size_t i = 0; i < points.size(); ++i) add(points[i]);
  }

  [[nodiscard]] Points means(int min_clouds) const {
    Points means;
    for (const Sum& sum : sums_) {
      if (sum.clouds < min_clouds) continue;
      means.push_back({static_cast<float>(sum.x / sum.points), static_cast<float>(sum.y / sum.points),
                       static_cast<float>(sum.z / sum.points)});
    }
    return means;
  }

 private:
  struct Sum {
    double x = 0.0, y = 0.0, z = 0.0;  ///< m
    double points = 0.0;
    int clouds = 0;
    int last_cloud = 0;
  };

  void add(const Point& p) {
    const auto number = [this](double place) { return static_cast<std::int32_t>(std::floor(place / side_)); };
    const std::uint32_t cube = cubes_.find_or_add({number(p.x), number(p.y), number(p.z)});
    if (cube == sums_.size()) sums_.emplace_back();
    Sum& sum = sums_[cube];
    sum.x += p.x;
    sum.y += p.y;
    sum.z += p.z;
    sum.points += 1.0;
    if (std::exchange(sum.last_cloud, clouds_) != clouds_) ++sum.clouds;
  }

  double side_;
  int clouds_ = 0;
  std::vector<Sum> sums_;
  VoxelNumbers<std::int32_t> cubes_;
};

}  // namespace

CloudDriveMap::Params::Params() {
  drive.keyframes = {0.0, 0.0};
  drive.voxel_size = 0.0;
}

void describe(ParamVisitor& v, CloudDriveMap::Params& p) {
  describe(v, p.drive);
  v.field("resolution", p.resolution,
          {.doc = "Side of the cubes that have a point each, the mean of all that was met there.",
           .unit = "m",
           .min = least_resolution,
           .max = 10.0});
  v.field("min_clouds", p.min_clouds,
          {.doc = "A cube has a point only if at least so many clouds have met it: people are soon gone.",
           .min = 1,
           .audience = Audience::tuner});
  v.require(!p.drive.reference.text.empty(), "reference",
            "must be given: a map needs to know where clouds lie");
}

CloudDriveMap::CloudDriveMap(const Params& params, const SourceSetup& setup)
    : params_(params), setup_(setup) {}

MapData CloudDriveMap::load() {
  CloudDrive drive(params_.drive, setup_);
  CubeSums sums(params_.resolution);
  MapData map;
  std::vector<Pose3> path;
  while (const auto sample = drive.next()) {
    if (!sample->map_from_robot) continue;
    if (path.empty()) map.origin = origin_near(sample->map_from_robot->translation(), setup_.motion);
    path.push_back(shifted(*sample->map_from_robot, -map.origin));
    sums.add(moved(sample->observation.scan.hits, path.back()));
  }
  map.points = sums.means(params_.min_clouds);
  map.resolution = params_.resolution;
  map.path = sparse_path(path);
  if (map.points.empty()) {
    throw ConfigError(params_.drive.folder.resolved,
                      "its map has no point; lower min_clouds, raise max_range, or use more "
                      "clouds with reference poses");
  }
  return map;
}

}  // namespace glocal::clouds
