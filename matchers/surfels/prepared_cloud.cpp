#include "matchers/surfels/prepared_cloud.hpp"

#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace glocal::surfels {

SurfelSample sample_of(const Surfels& surfels, std::size_t n, Rng& rng) {
  // Systematic: at equal steps along the sum of the weights.
  const double sum = std::accumulate(surfels.weights.begin(), surfels.weights.end(), 0.0);
  const double step = sum / static_cast<double>(n);
  std::vector<std::uint32_t> drawn;
  double next = step * rng.uniform();
  double so_far = 0.0;
  for (std::size_t i = 0; i < surfels.size(); ++i) {
    so_far += static_cast<double>(surfels.weights[i]);
    for (; next < so_far; next += step) drawn.push_back(static_cast<std::uint32_t>(i));
  }
  for (std::size_t i = drawn.size(); i > 1; --i)
    std::swap(drawn[i - 1], drawn[rng.below(static_cast<std::uint32_t>(i))]);
  SurfelSample sample;
  for (const std::uint32_t i : drawn) {
    sample.points.push_back(surfels.points[i]);
    sample.normals.push_back(surfels.normals[i]);
  }
  if (!drawn.empty()) sample.middle = as_point(centroid(sample.points));
  return sample;
}

PreparedCloud::PreparedCloud(const Points& cloud, float voxel_size, const std::optional<Point>& seen_from)
    : surfels(surfels_of(cloud, voxel_size, seen_from)), contact(surfels, voxel_size, seen_from.has_value()) {
  if (seen_from) view.emplace(cloud, *seen_from);
}

Agreement agreement_of(const Surfels& moved, const RigidMotion& motion, const PreparedCloud& other) {
  double in_contact = 0.0;
  double seen_through = 0.0;
  double all = 0.0;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    const auto weight = static_cast<double>(moved.weights[i]);
    const Point p = motion(moved.points[i]);
    const Point normal = motion.turned(moved.normals[i]);
    all += weight;
    if (other.contact.touches(p, normal)) {
      in_contact += weight;
    } else if (other.view && other.view->saw_through(p, normal, other.contact.reach())) {
      seen_through += weight;
    }
  }
  if (all == 0.0) return {};
  return {in_contact / all, seen_through / all};
}

}  // namespace glocal::surfels
