#include <fmt/format.h>

#include "sources/clouds/cloud_formats.hpp"
#include "sources/clouds/scalar.hpp"

namespace glocal::clouds {

Cloud read_kitti_cloud(std::string_view content, const std::string& file, const CloudOptions& options) {
  constexpr std::size_t value_size = 4, point_size = 4 * value_size;
  if (content.size() % point_size != 0)
    refuse_cloud(
        file, 0,
        fmt::format("has {} bytes, {} more than {} points of {} bytes (x y z intensity, float32); "
                    "get a fresh copy, or convert it to PCD if its points have other values",
                    content.size(), content.size() % point_size, content.size() / point_size, point_size));
  CloudBuilder cloud(file, options, channel_columns({"x", "y", "z"}, file, 0));
  for (; !content.empty(); content.remove_prefix(point_size)) {
    PointValues values{};
    for (std::size_t i = 0; i < 3; ++i)
      values.at(i) = number_at<float>(content.data() + i * value_size, std::endian::little);
    cloud.add(values);
  }
  return cloud.finish();
}

}  // namespace glocal::clouds
