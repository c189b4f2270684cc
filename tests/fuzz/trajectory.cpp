// Poses over time, of TUM or KITTI.
#include <cmath>
#include <limits>

#include "fuzz/harness.hpp"
#include "sources/clouds/trajectory_file.hpp"

namespace glocal::fuzz {
namespace {

void check_trajectory(const clouds::Trajectory& trajectory) {
  must_hold(!trajectory.poses.empty(), "a trajectory has poses");
  double last = -std::numeric_limits<double>::infinity();
  for (const auto& [stamp, pose] : trajectory.poses) {
    must_hold(std::isfinite(stamp) && stamp >= last, "stamps do not fall");
    last = stamp;
    for (const double v : {pose.x, pose.y, pose.z}) must_hold(std::abs(v) <= farthest_m, "a place is none");
    const Quaternion& q = pose.rotation;
    const double length = std::hypot(std::hypot(q.w(), q.x()), std::hypot(q.y(), q.z()));
    must_hold(std::abs(length - 1.0) < 1e-12, "quaternions have length 1");
  }
}

}  // namespace
}  // namespace glocal::fuzz

extern "C" int fuzz_trajectory(const std::uint8_t* data, std::size_t size) {
  using namespace glocal;
  const std::string_view content(reinterpret_cast<const char*>(data), size);
  return fuzz::answer([&] { fuzz::check_trajectory(clouds::parse_trajectory(content, "poses")); });
}
