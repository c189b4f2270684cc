#include "glocal/contact.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "glocal/error.hpp"

namespace glocal {
namespace {

constexpr double voxels_per_epsilon = 4.0;
constexpr double largest_bytes = 1024.0 * 1024.0 * 1024.0;

struct Range {
  double low;
  double high;
};

Range range_of(const std::vector<float>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return {*low, *high};
}

}  // namespace

ContactGrid::ContactGrid(const Points& points, double epsilon) {
  if (points.empty()) return;
  const double voxel = epsilon / voxels_per_epsilon;
  const double margin = epsilon + voxel;
  const Range x = range_of(points.x);
  const Range y = range_of(points.y);
  const Range z = range_of(points.z);
  const bool planar = z.low == z.high;
  const auto voxels = [&](const Range& r) {
    return std::ceil((r.high - r.low + 2.0 * margin) / voxel) + 1.0;
  };
  const double columns = std::ceil(voxels(x) / 64.0) * 64.0;
  const double rows = voxels(y);
  const double layers = planar ? 1.0 : voxels(z);
  const double bytes = columns * rows * layers / 8.0;
  if (!(bytes <= largest_bytes)) {
    throw ConfigError(
        {{"", 0, 0,
          fmt::format("a contact grid over {:.0f} m x {:.0f} m x {:.0f} m with contact_epsilon {} m would "
                      "need {:.1f} GiB, at most 1 GiB is allowed; use a larger contact_epsilon or a "
                      "smaller map",
                      x.high - x.low, y.high - y.low, z.high - z.low, epsilon, bytes / largest_bytes)}});
  }
  min_ = {static_cast<float>(x.low - margin), static_cast<float>(y.low - margin),
          static_cast<float>(planar ? z.low - epsilon : z.low - margin)};
  scale_ = static_cast<float>(1.0 / voxel);
  scale_z_ = planar ? static_cast<float>(0.5 / epsilon) : scale_;
  columns_ = static_cast<float>(columns);
  rows_ = static_cast<float>(rows);
  layers_ = static_cast<float>(layers);
  row_stride_ = static_cast<std::size_t>(columns);
  layer_stride_ = row_stride_ * static_cast<std::size_t>(rows);
  bits_.assign(layer_stride_ * static_cast<std::size_t>(layers) / 64, 0);
  for (std::size_t i = 0; i < points.size(); ++i) dilate(points[i], epsilon);
}

std::shared_ptr<const ContactGrid> ContactGrid::of(const GlobalMap& map, double epsilon) {
  return map.index<ContactGrid>(fmt::format("{}", epsilon),
                                [&] { return ContactGrid(map.points(), epsilon); });
}

void ContactGrid::dilate(const Point& p, double epsilon) {
  // In voxels, relative to voxel (0, 0, 0).
  const double reach = epsilon * scale_;
  const double x = (static_cast<double>(p.x) - min_.x) * scale_;
  const double y = (static_cast<double>(p.y) - min_.y) * scale_;
  const double z = (static_cast<double>(p.z) - min_.z) * scale_;
  const bool planar = layers_ == 1.0F;
  const auto first = [&](double centre) { return static_cast<int>(std::ceil(centre - reach - 0.5)); };
  const auto last = [&](double centre) { return static_cast<int>(std::floor(centre + reach - 0.5)); };
  const auto squared = [](double centre, int voxel) {
    const double d = voxel + 0.5 - centre;
    return d * d;
  };
  const int first_layer = planar ? 0 : first(z);
  const int last_layer = planar ? 0 : last(z);
  for (int layer = first_layer; layer <= last_layer; ++layer) {
    const double left_by_z = reach * reach - (planar ? 0.0 : squared(z, layer));
    for (int row = first(y); row <= last(y); ++row) {
      const double left_by_y = left_by_z - squared(y, row);
      for (int column = first(x); column <= last(x); ++column) {
        if (squared(x, column) > left_by_y) continue;
        const std::size_t bit = bit_index(static_cast<std::size_t>(column), static_cast<std::size_t>(row),
                                          static_cast<std::size_t>(layer));
        bits_[bit >> 6U] |= std::uint64_t{1} << (bit & 63U);
      }
    }
  }
}

}  // namespace glocal
