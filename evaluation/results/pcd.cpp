#include "evaluation/results/pcd.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <string_view>

#include "config/text_file.hpp"
#include "evaluation/results/file_io.hpp"
#include "glocal/error.hpp"

namespace glocal {
namespace {

static_assert(std::endian::native == std::endian::little, "binary PCD files are little-endian");

using Xyz = std::array<float, 3>;

constexpr float farthest_m = 2.0e6F;

std::string header(std::size_t points) {
  return fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT "
      "1 1 1\n"
      "WIDTH {0}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {0}\nDATA binary\n",
      points);
}

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& what) {
  throw ConfigError({{file.string(), 0, 0, what + "; run the experiment again"}});
}

/// How many points a header as header() makes it announces; none if this is no such header.
std::optional<std::size_t> announced(std::string_view content) {
  constexpr std::string_view key = "WIDTH ";
  const std::size_t at = content.substr(0, 200).find(key);
  if (at == std::string_view::npos) return std::nullopt;
  std::size_t points = 0;
  const char* const number = content.data() + at + key.size();
  if (std::from_chars(number, content.data() + content.size(), points).ec != std::errc{}) return std::nullopt;
  return content.starts_with(header(points)) ? std::optional(points) : std::nullopt;
}

bool is_near(float coordinate) {
  return std::abs(coordinate) < farthest_m;  // false for NaN
}

}  // namespace

std::string pcd(const Points& points) {
  std::string text = header(points.size());
  const std::size_t begin = text.size();
  text.resize(begin + points.size() * sizeof(Xyz));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Xyz xyz = {points.x[i], points.y[i], points.z[i]};
    std::memcpy(text.data() + begin + i * sizeof(Xyz), xyz.data(), sizeof(Xyz));
  }
  return text;
}

Points read_pcd(const std::filesystem::path& file) {
  if (const auto why = why_unreadable(file)) refuse(file, "cannot be read");
  const std::string content = content_of(file);
  const auto n = announced(content);
  if (!n) refuse(file, "is no PCD file as glocal run leaves it (binary, x y z)");
  const std::size_t begin = header(*n).size();
  if ((content.size() - begin) / sizeof(Xyz) != *n || (content.size() - begin) % sizeof(Xyz) != 0)
    refuse(file, fmt::format("has {} bytes of points where its header announces {} points of {} bytes",
                             content.size() - begin, *n, sizeof(Xyz)));
  Points points;
  points.reserve(*n);
  for (std::size_t i = 0; i < *n; ++i) {
    Xyz xyz{};
    std::memcpy(xyz.data(), content.data() + begin + i * sizeof(Xyz), sizeof(Xyz));
    if (!std::all_of(xyz.begin(), xyz.end(), is_near))
      refuse(file, fmt::format("has a coordinate that is no length within 2000 km, in point {}", i));
    points.push_back({xyz[0], xyz[1], xyz[2]});
  }
  return points;
}

}  // namespace glocal
