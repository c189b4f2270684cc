// What holds for every cloud that is read, whatever its format.
#pragma once

#include <algorithm>
#include <cmath>

#include "fuzz/harness.hpp"
#include "sources/clouds/cloud_file.hpp"

namespace glocal::fuzz {

inline void check_cloud(const clouds::Cloud& cloud) {
  const std::size_t n = cloud.points.size();
  must_hold(n > 0, "a cloud has points");
  for (const auto* axis : {&cloud.points.x, &cloud.points.y, &cloud.points.z}) {
    const auto is_near = [](float v) { return std::abs(v) <= static_cast<float>(farthest_m); };
    must_hold(axis->size() == n && std::all_of(axis->begin(), axis->end(), is_near), "a place is none");
  }
  must_hold(cloud.normals.empty() || cloud.normals.size() == n, "there is one normal for each point");
  for (std::size_t i = 0; i < cloud.normals.size(); ++i) {
    const Point normal = cloud.normals[i];
    must_hold(std::abs(std::hypot(normal.x, normal.y, normal.z) - 1.0F) < 1e-4F, "normals have length 1");
  }
  must_hold(cloud.times.empty() || cloud.times.size() == n, "there is one time for each point");
  const auto is_time = [](double t) { return std::isfinite(t) && t >= 0.0; };
  must_hold(std::all_of(cloud.times.begin(), cloud.times.end(), is_time), "a time is none");
  static_cast<void>(clouds::cloud_remarks(cloud));
}

/// Tries a reader of one format; no byte behind the input belongs to it.
template <class Read>
int try_cloud(const std::uint8_t* data, std::size_t size, Read read,
              const clouds::CloudOptions& options = {}) {
  return answer([&] {
    check_cloud(read(std::string_view(reinterpret_cast<const char*>(data), size), "cloud", options));
  });
}

}  // namespace glocal::fuzz
