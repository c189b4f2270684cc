#include "kd_tree_contact.hpp"

#include <cmath>
#include <vector>

namespace glocal::pcl_plugin {
namespace {

/// PCL must not be asked about points that are not numbers; those far away would overflow when squared.
bool is_usable(const Point& p) {
  constexpr float far = 1e6F;
  return std::abs(p.x) < far && std::abs(p.y) < far && std::abs(p.z) < far;
}

}  // namespace

PclKdTreeContact::PclKdTreeContact(const Params& /*params*/, const ContactSetup& setup)
    : squared_epsilon_(static_cast<float>(setup.epsilon * setup.epsilon)) {
  tree_.setInputCloud(cloud(*setup.map_points));
}

std::size_t PclKdTreeContact::count(const Points& points, std::size_t begin, std::size_t n,
                                    const Transform& map_from_points) const {
  pcl::Indices nearest(1);
  std::vector<float> squared_distance(1);
  std::size_t in_contact = 0;
  for (std::size_t i = begin; i < begin + n; ++i) {
    const Point p = map_from_points(points[i]);
    if (!is_usable(p)) continue;
    tree_.nearestKSearch({p.x, p.y, p.z}, 1, nearest, squared_distance);
    if (squared_distance.front() < squared_epsilon_) ++in_contact;
  }
  return in_contact;
}

std::size_t PclKdTreeContact::memory_bytes() const {
  return tree_.getInputCloud()->size() * sizeof(pcl::PointXYZ);
}

}  // namespace glocal::pcl_plugin
