#include "glocal/limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace glocal {
namespace {

constexpr double ns_per_s = 1e9;
constexpr double latest_stamp_s = static_cast<double>(latest_stamp_ns) / ns_per_s;

std::string stamp_fault(double seconds) {
  return fmt::format(
      "a time stamp of {:g} s is out of range, at most {:g} s before or after 1970 are "
      "allowed; correct it",
      seconds, latest_stamp_s);
}

/// The largest distance of points from the origin along an axis, where they are `by` farther.
double farthest_of(const Points& points, const Vector3& by) {
  double farthest = 0.0;
  const auto look_along = [&](const std::vector<float>& values, double more) {
    for (const float value : values) farthest = std::max(farthest, std::abs(more + value));
  };
  look_along(points.x, by.x());
  look_along(points.y, by.y());
  look_along(points.z, by.z());
  return farthest;
}

/// How far neighbouring numbers of single precision lie apart.
double spacing_at(double value) {
  const auto single = static_cast<float>(value);
  return static_cast<double>(std::nextafter(single, std::numeric_limits<float>::infinity()) - single);
}

}  // namespace

std::string fault_of_resolution(double metres) {
  if (metres >= least_resolution && metres <= largest_resolution) return "";
  return fmt::format(
      "a resolution of {:g} m is out of range, must be {:g} to {:g} m; correct it, or the unit", metres,
      least_resolution, largest_resolution);
}

std::string fault_of_stamp(double seconds) {
  if (std::abs(seconds) <= latest_stamp_s) return "";
  return stamp_fault(seconds);
}

std::string fault_of_stamp_ns(std::int64_t ns) {
  if (ns >= -latest_stamp_ns && ns <= latest_stamp_ns) return "";
  return stamp_fault(static_cast<double>(ns) / ns_per_s);
}

std::string fault_of_scan_times(double first_s, double last_s) {
  std::string fault = fault_of_stamp(first_s);
  if (fault.empty()) fault = fault_of_stamp(last_s);
  if (fault.empty() && !(std::abs(last_s - first_s) <= longest_scan_s))
    fault = fmt::format("its readings' times are from {:g} to {:g} s, at most {:g} s apart are allowed",
                        first_s, last_s, longest_scan_s);
  return fault;
}

std::string fault_of_map(const MapData& map) {
  const double cells = static_cast<double>(map.grid.width) * map.grid.height;
  if (cells > max_grid_cells)
    return fmt::format("{} x {} cells are more than {:g}; take a coarser resolution, or cut the map",
                       map.grid.width, map.grid.height, max_grid_cells);
  const double in_frame = farthest_of(map.points, map.origin);
  if (in_frame > farthest_m)
    return fmt::format("a place {:g} m from the origin, at most {:g} m are allowed; correct it, or the unit",
                       in_frame, farthest_m);
  const double resolution = map.grid.resolution > 0.0 ? map.grid.resolution : map.resolution;
  if (resolution == 0.0) return "";
  if (std::string fault = fault_of_resolution(resolution); !fault.empty()) return fault;
  constexpr double spacings_per_cell = 8.0;
  const double farthest = farthest_of(map.points, Vector3::Zero());
  const double spacing = spacing_at(farthest);
  if (spacing * spacings_per_cell <= resolution) return "";
  const bool is_far = !map.origin.isZero(0.0);
  return fmt::format(
      "places {:.0f} m from {}, where single precision is good to {:.2g} m, are too far for a map of {:g} m "
      "resolution; {}",
      farthest, is_far ? "its own origin" : "the origin", spacing, resolution,
      is_far ? "cut the map" : "move the map (and reference poses) nearer to its origin, or cut it");
}

}  // namespace glocal
