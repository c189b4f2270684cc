// Messages of ROS that say where a robot is and what it sees; the definitions are those of common_msgs, which
// ROS 1 and 2 share but for the header's sequence number.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "glocal/points.hpp"
#include "glocal/pose3.hpp"
#include "sources/bags/recording.hpp"

namespace glocal::bags {

// Each read_…() throws ConfigError, naming file and byte, for a message that is shorter than its definition
// wants, has lengths that lie, a quaternion whose length is off 1 by more than 0.01, or a place that is not
// finite. It is up to the caller that the connection's type is the right one.

/// std_msgs/Header
struct Header {
  std::int64_t stamp_ns = 0;  ///< When it was measured.
  std::string frame;          ///< Without the slash that old names begin with.
};

/// The header alone, of messages that begin with one; none if it breaks its definition.
[[nodiscard]] std::optional<Header> readable_header(const RecordedMessage& message);

/// sensor_msgs/LaserScan; angles in rad about the frame's z axis, ranges in m, times in s.
struct LaserScan {
  Header header;
  float angle_min = 0.0F, angle_max = 0.0F, angle_increment = 0.0F;
  float time_increment = 0.0F, scan_time = 0.0F;
  float range_min = 0.0F, range_max = 0.0F;
  std::vector<float> ranges;  ///< Perhaps infinite or NaN.
};
[[nodiscard]] LaserScan read_laser_scan(const RecordedMessage& message);

/// sensor_msgs/PointCloud2. Points with a coordinate or time that is not finite, and those beyond
/// `farthest_m`, are left out.
struct PointCloud {
  Header header;
  Points points;              ///< m, in the header's frame.
  std::vector<double> times;  ///< s, one for each point, empty if not known. Their origin is the driver's.
  std::size_t left_out = 0;
};
/// Times are of the field t, time, timestamp or offset_time: whole numbers are ns, others s, or ns where they
/// are too large for stamps in s.
[[nodiscard]] PointCloud read_point_cloud(const RecordedMessage& message);

/// nav_msgs/Odometry
struct Odometry {
  Header header;
  std::string child_frame;
  Pose3 frame_from_child;
};
[[nodiscard]] Odometry read_odometry(const RecordedMessage& message);

/// geometry_msgs/TransformStamped
struct FrameTransform {
  Header header;  ///< Its frame is the parent.
  std::string child_frame;
  Pose3 parent_from_child;
};
/// tf2_msgs/TFMessage, tf/tfMessage
[[nodiscard]] std::vector<FrameTransform> read_transforms(const RecordedMessage& message);
[[nodiscard]] bool has_transforms(std::string_view type);

/// geometry_msgs/PoseStamped, geometry_msgs/PoseWithCovarianceStamped
struct StampedFramePose {
  Header header;
  Pose3 pose;
  std::vector<double> covariance;  ///< Row by row of (x, y, z, rotations about x, y, z), m and rad; or empty.
};
[[nodiscard]] StampedFramePose read_pose(const RecordedMessage& message);
[[nodiscard]] bool is_pose(std::string_view type);

/// nav_msgs/OccupancyGrid
struct GridMessage {
  Header header;
  double resolution = 0.0;  ///< Side of cells, m.
  std::uint32_t width = 0, height = 0;
  Pose3 frame_from_grid;           ///< Of the corner of the first cell.
  std::vector<std::int8_t> cells;  ///< Row by row: probability of being occupied, %; -1 is unknown.
};
[[nodiscard]] GridMessage read_occupancy_grid(const RecordedMessage& message);

}  // namespace glocal::bags
