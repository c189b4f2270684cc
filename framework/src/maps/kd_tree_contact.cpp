#include <array>
#include <cstddef>
#include <memory>
#include <nanoflann.hpp>

#include "glocal/contact.hpp"

namespace glocal {
namespace {

constexpr std::size_t points_per_leaf = 10;

/// Points as nanoflann wants to see them.
struct PointCloud {
  Points points;

  // NOLINTBEGIN(readability-identifier-naming): nanoflann's names
  [[nodiscard]] std::size_t kdtree_get_point_count() const { return points.size(); }
  [[nodiscard]] float kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return axis == 0 ? points.x[i] : axis == 1 ? points.y[i] : points.z[i];
  }
  template <class Box>
  bool kdtree_get_bbox(Box& /*box*/) const {
    return false;
  }
  // NOLINTEND(readability-identifier-naming)
};

/// A search that ends with the first point nearer than a distance.
class FirstWithin {
 public:
  explicit FirstWithin(float squared_distance) : squared_distance_(squared_distance) {}

  // NOLINTBEGIN(readability-identifier-naming): nanoflann's names
  using DistanceType = float;
  [[nodiscard]] std::size_t size() const { return found_ ? 1 : 0; }
  [[nodiscard]] bool full() const { return found_; }
  [[nodiscard]] float worstDist() const { return squared_distance_; }
  /// Whether to go on. A comparison with NaN is false.
  bool addPoint(float squared_distance, std::size_t /*index*/) {
    found_ = squared_distance < squared_distance_;
    return !found_;
  }
  // NOLINTEND(readability-identifier-naming)

 private:
  float squared_distance_;
  bool found_ = false;
};

using NanoflannTree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, PointCloud>, PointCloud, 3>;

}  // namespace

struct KdTreeContact::Tree {
  Tree(const Points& points, double epsilon)
      : cloud{points},
        squared_epsilon(static_cast<float>(epsilon * epsilon)),
        index(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(points_per_leaf)) {}

  PointCloud cloud;
  float squared_epsilon;
  NanoflannTree index;
};

KdTreeContact::KdTreeContact(const Points& points, double epsilon)
    : tree_(std::make_unique<Tree>(points, epsilon)) {}
KdTreeContact::~KdTreeContact() = default;

std::size_t KdTreeContact::count(const Points& points, std::size_t begin, std::size_t n,
                                 const Transform& map_from_points) const {
  if (tree_->cloud.points.empty()) return 0;
  std::size_t in_contact = 0;
  for (std::size_t i = begin; i < begin + n; ++i) {
    const Point p = map_from_points(points[i]);
    const std::array<float, 3> query{p.x, p.y, p.z};
    FirstWithin search(tree_->squared_epsilon);
    tree_->index.findNeighbors(search, query.data(), nanoflann::SearchParams());
    if (search.full()) ++in_contact;
  }
  return in_contact;
}

std::size_t KdTreeContact::memory_bytes() const {
  return tree_->index.usedMemory(tree_->index) + 3 * sizeof(float) * tree_->cloud.points.size();
}

}  // namespace glocal
