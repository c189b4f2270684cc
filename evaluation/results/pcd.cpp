#include "evaluation/results/pcd.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <optional>
#include <string_view>

#include "config/text_file.hpp"
#include "evaluation/results/file_io.hpp"
#include "glocal/error.hpp"

namespace glocal {
namespace {

static_assert(std::endian::native == std::endian::little, "binary PCD files are little-endian");

/// Bytes of a coordinate.
constexpr std::size_t single_size = sizeof(float), double_size = sizeof(double);

std::string header(std::size_t points, std::size_t size) {
  return fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z\nSIZE {1} {1} {1}\n"
      "TYPE F F F\nCOUNT 1 1 1\nWIDTH {0}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {0}\nDATA binary\n",
      points, size);
}

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& what) {
  throw ConfigError(file, what + "; run the experiment again");
}

/// What a header as header() makes it announces.
struct Announced {
  std::size_t points, size;
};

/// None if this is no such header.
std::optional<Announced> announced(std::string_view content) {
  constexpr std::string_view key = "WIDTH ";
  const std::size_t at = content.substr(0, 200).find(key);
  if (at == std::string_view::npos) return std::nullopt;
  std::size_t points = 0;
  const char* const number = content.data() + at + key.size();
  if (std::from_chars(number, content.data() + content.size(), points).ec != std::errc{}) return std::nullopt;
  for (const std::size_t size : {single_size, double_size}) {
    if (content.starts_with(header(points, size))) return Announced{points, size};
  }
  return std::nullopt;
}

template <class Number>
void append(std::string& text, const Vector3& place) {
  const std::array xyz = {static_cast<Number>(place.x()), static_cast<Number>(place.y()),
                          static_cast<Number>(place.z())};
  text.append(reinterpret_cast<const char*>(xyz.data()), sizeof xyz);
}

template <class Number>
Vector3 place_at(const char* bytes) {
  std::array<Number, 3> xyz{};
  std::memcpy(xyz.data(), bytes, sizeof xyz);
  return {xyz[0], xyz[1], xyz[2]};
}

}  // namespace

std::string pcd(const Points& points, const Vector3& origin) {
  const bool is_far = !origin.isZero(0.0);
  const std::size_t size = is_far ? double_size : single_size;
  std::string text = header(points.size(), size);
  text.reserve(text.size() + points.size() * 3 * size);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (is_far) {
      append<double>(text, origin + as_vector(points[i]));
    } else {
      append<float>(text, as_vector(points[i]));
    }
  }
  return text;
}

MapPoints read_map_pcd(const std::filesystem::path& file) {
  if (const auto why = why_unreadable(file)) refuse(file, "cannot be read");
  const std::string content = content_of(file);
  const auto told = announced(content);
  if (!told) refuse(file, "is no PCD file as glocal run leaves it (binary, x y z)");
  const auto [n, size] = *told;
  const std::size_t begin = header(n, size).size(), point_size = 3 * size;
  if ((content.size() - begin) / point_size != n || (content.size() - begin) % point_size != 0)
    refuse(file, fmt::format("has {} bytes of points where its header announces {} points of {} bytes",
                             content.size() - begin, n, point_size));
  MapPoints map;
  map.points.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    const char* const bytes = content.data() + begin + i * point_size;
    const Vector3 place = size == double_size ? place_at<double>(bytes) : place_at<float>(bytes);
    if (i == 0 && size == double_size) map.origin = origin_near(place);
    const Vector3 relative = place - map.origin;
    constexpr double farthest_shown_m = 2.0e6;
    // Negated so that NaN is refused.
    if (!((relative.array().abs() < farthest_shown_m).all() && (place.array().abs() <= farthest_m).all()))
      refuse(file, fmt::format("has a coordinate that is no length within 2000 km, in point {}", i));
    map.points.push_back(as_point(relative));
  }
  return map;
}

Points read_pcd(const std::filesystem::path& file) {
  return read_map_pcd(file).points;
}

}  // namespace glocal
