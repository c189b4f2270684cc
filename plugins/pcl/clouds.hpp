// From glocal's values to PCL's, and back.
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <Eigen/Core>
#include <cstddef>

#include "glocal/points.hpp"
#include "glocal/pose2.hpp"

namespace glocal::pcl_plugin {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

/// At most so many of the points, spread evenly over them; 0: all.
[[nodiscard]] Cloud::Ptr cloud(const Points& points, std::size_t at_most = 0);

/// A planar motion as PCL has it, and as glocal does.
[[nodiscard]] Eigen::Matrix4f matrix(const Pose2& pose);
[[nodiscard]] Pose2 pose(const Eigen::Matrix4f& matrix);

}  // namespace glocal::pcl_plugin
