// Clouds of points as files hold them, whatever the format.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "glocal/global_map.hpp"
#include "glocal/params.hpp"
#include "glocal/points.hpp"
#include "glocal/pose3.hpp"
#include "sources/compressed_file.hpp"

namespace glocal::clouds {

/// What a file says of its points. Points with a coordinate or time that is no finite number are left out.
struct Cloud {
  Points points;                     ///< m, in the file's frame less `origin`. Empty only of a scan.
  Vector3 origin = Vector3::Zero();  ///< m; other than 0 only of a map's cloud.
  Points normals;                    ///< Unit normals, one for each point; empty unless all points have one.
  std::vector<double> times;         ///< s since the earliest point, one for each point; empty if not known.
  Pose3 viewpoint;             ///< Where a PCD file says the sensor was, m; the identity if nothing is said.
  double voxel_size = 0.0;     ///< Side of the cubes whose centres the points of an octree are, m; else 0.
  std::size_t not_finite = 0;  ///< Points left out.
};

/// How clouds are read.
struct CloudOptions {
  double unit = 1.0;  ///< Length of the file's unit, m.
  double max_size_gb = default_max_size_gb;
  /// Of a map, what of poses is looked for in it: points are relative to an origin_near() the first one.
  std::optional<Motion> map_motion = {};
  /// Of a drive: it may be empty, and times of points are those of its rays, within limits.hpp's bounds.
  bool is_scan = false;
};

/// The field that says `unit`, for everything that reads clouds.
void describe_cloud_unit(ParamVisitor& v, double& unit);

/// The values of a point that are of use.
enum class Channel { x, y, z, normal_x, normal_y, normal_z, time };
inline constexpr std::size_t channels = 7;
using PointValues = std::array<double, channels>;

/// Where in a list of names each channel is.
using ChannelColumns = std::array<std::optional<std::size_t>, channels>;

/// Finds the channels by their names: x y z, normal_x … or nx …, time or t or timestamp. Normals are only
/// taken if all three are there. Throws ConfigError at the line if x, y or z is missing or a channel is there
/// twice.
[[nodiscard]] ChannelColumns channel_columns(const std::vector<std::string_view>& names,
                                             const std::string& file, int line);

/// Throws ConfigError; line 0 is none.
[[noreturn]] void refuse_cloud(const std::string& file, int line, std::string message);

/// Makes a cloud of values, point by point.
class CloudBuilder {
 public:
  /// `time_unit`: s.
  CloudBuilder(std::string file, const CloudOptions& options, const ChannelColumns& columns,
               double time_unit = 1.0);

  /// Makes room for so many points, so that they take no more memory than they need.
  void reserve(std::size_t points) { cloud_.points.reserve(points); }
  /// The next point; values of channels without column are ignored. Throws ConfigError if it is beyond
  /// `farthest_m`.
  void add(const PointValues& values, int line = 0);
  /// Throws ConfigError if no point is left, but of a scan, whose times it checks.
  [[nodiscard]] Cloud finish();

 private:
  void add_normal(const Vector3& normal);

  std::string file_;
  double unit_, time_unit_;
  std::optional<Motion> map_motion_;
  bool is_scan_, has_normals_, has_times_;
  std::size_t points_ = 0;  ///< Added, of any kind.
  Cloud cloud_;
};

}  // namespace glocal::clouds
