#include "glocal/plugin.hpp"

#include "ros2_link.hpp"

GLOCAL_PLUGIN("glocal_ros2", "0.1.0", catalog) {
  using namespace glocal;
  catalog.message_links.add<ros2_plugin::Ros2Link>(
      "ros2", "Topics of ROS 2, by DDS: ROS itself need not be installed.", experimental_since("0.1.0"));
}
