// Contact by PCL's kd-tree.
#pragma once

#include <pcl/kdtree/kdtree_flann.h>

#include <cstddef>

#include "clouds.hpp"
#include "glocal/contact.hpp"

namespace glocal::pcl_plugin {

/// Exact: the nearest point of the map is nearer than epsilon.
class PclKdTreeContact final : public ContactIndex {
 public:
  using Params = NoParams;

  PclKdTreeContact(const Params& params, const ContactSetup& setup);

  [[nodiscard]] std::size_t count(const Points& points, std::size_t begin, std::size_t n,
                                  const Transform& map_from_points) const override;
  /// The points alone: PCL does not tell how large its tree is.
  [[nodiscard]] std::size_t memory_bytes() const override;

 private:
  pcl::KdTreeFLANN<pcl::PointXYZ> tree_;
  float squared_epsilon_;
};

}  // namespace glocal::pcl_plugin
