// Messages of recordings: the first byte chooses the type, the second the encoding.
#include <array>

#include "fuzz/harness.hpp"
#include "sources/bags/cdr_writer.hpp"
#include "sources/bags/messages.hpp"

extern "C" int fuzz_bag_messages(const std::uint8_t* data, std::size_t size) {
  using namespace glocal;
  if (size < 2) return 0;
  constexpr std::array readers = {
      +[](const bags::RecordedMessage& m) { static_cast<void>(bags::read_laser_scan(m)); },
      +[](const bags::RecordedMessage& m) {
        const bags::PointCloud cloud = bags::read_point_cloud(m);
        fuzz::must_hold(cloud.times.empty() || cloud.times.size() == cloud.points.size(),
                        "each point has a time");
      },
      +[](const bags::RecordedMessage& m) { static_cast<void>(bags::read_odometry(m)); },
      +[](const bags::RecordedMessage& m) { static_cast<void>(bags::read_transforms(m)); },
      +[](const bags::RecordedMessage& m) { static_cast<void>(bags::read_pose(m)); },
      +[](const bags::RecordedMessage& m) { static_cast<void>(bags::read_occupancy_grid(m)); },
      +[](const bags::RecordedMessage& m) {
        bags::Connection of_ros1{"/topic", "sensor_msgs/PointCloud2", "ros1", ""};
        const std::string cdr = bags::as_cdr({&of_ros1, 0, m.bytes, {"file"}});
        of_ros1.encoding = "cdr";
        static_cast<void>(bags::read_point_cloud({&of_ros1, 0, cdr, {"file"}}));
      }};
  const bags::Connection connection{"/topic", "geometry_msgs/PoseWithCovarianceStamped",
                                    data[1] % 2 == 0 ? "ros1" : "cdr", ""};
  const std::string bytes = fuzz::text_of(data + 2, size - 2);
  return fuzz::answer([&] { readers.at(data[0] % readers.size())({&connection, 0, bytes, {"file"}}); });
}
