#include "sources/clouds/cloud.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "glocal/error.hpp"
#include "glocal/limits.hpp"
#include "glocal/words.hpp"
#include "sources/text_lines.hpp"

namespace glocal::clouds {
namespace {

constexpr std::size_t index_of(Channel channel) {
  return static_cast<std::size_t>(channel);
}

std::optional<Channel> channel_called(std::string_view name) {
  if (name == "timestamp") return Channel::time;
  const auto channel =
      value_named<Channel>(name, {"x", "y", "z", "normal_x", "normal_y", "normal_z", "time"});
  return channel ? channel : value_named<Channel>(name, {"x", "y", "z", "nx", "ny", "nz", "t"});
}

std::string list_of(const std::vector<std::string_view>& names) {
  constexpr std::size_t most = 20;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), most); ++i) text += " " + shown(names[i]);
  return text + (names.size() > most ? " …" : "");
}

}  // namespace

void describe_cloud_unit(ParamVisitor& v, double& unit) {
  v.field("unit", unit,
          {.doc = "Length of the unit that coordinates are in; 0.001 for millimetres.",
           .unit = "m",
           .max = 1000.0,
           .above = 0.0});
}

void refuse_cloud(const std::string& file, int line, std::string message) {
  throw ConfigError({{file, line, 0, std::move(message)}});
}

ChannelColumns channel_columns(const std::vector<std::string_view>& names, const std::string& file,
                               int line) {
  ChannelColumns columns;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto channel = channel_called(names[i]);
    if (!channel) continue;
    auto& column = columns.at(index_of(*channel));
    if (column)
      refuse_cloud(file, line,
                   fmt::format("'{}' and '{}' are the same thing twice; leave out one of them",
                               names[*column], names[i]));
    column = i;
  }
  for (const auto& [channel, name] : {std::pair{Channel::x, 'x'}, {Channel::y, 'y'}, {Channel::z, 'z'}}) {
    if (!columns.at(index_of(channel)))
      refuse_cloud(file, line,
                   fmt::format("points have no {}; x, y and z are needed, there is:{}", name,
                               names.empty() ? " nothing" : list_of(names)));
  }
  const auto normal = columns.begin() + index_of(Channel::normal_x);
  if (!(normal[0] && normal[1] && normal[2])) std::fill_n(normal, 3, std::nullopt);
  return columns;
}

CloudBuilder::CloudBuilder(std::string file, const CloudOptions& options, const ChannelColumns& columns,
                           double time_unit)
    : file_(std::move(file)),
      unit_(options.unit),
      time_unit_(time_unit),
      map_motion_(options.map_motion),
      is_scan_(options.is_scan),
      has_normals_(columns[index_of(Channel::normal_x)].has_value()),
      has_times_(columns[index_of(Channel::time)].has_value()) {}

void CloudBuilder::add(const PointValues& values, int line) {
  const std::size_t number = points_++;
  const Vector3 place{unit_ * values[0], unit_ * values[1], unit_ * values[2]};
  const double time = has_times_ ? values[index_of(Channel::time)] : 0.0;
  if (!std::isfinite(place.sum() + time)) {
    ++cloud_.not_finite;
    return;
  }
  const double reach = place.lpNorm<Eigen::Infinity>();
  if (reach > farthest_m)
    refuse_cloud(file_, line,
                 fmt::format("point {} (from 0) has a coordinate of {:g} m, at most {:g} are allowed; if "
                             "the file is not in metres, give its unit, else get a fresh copy",
                             number, reach, farthest_m));
  if (map_motion_ && cloud_.points.empty()) cloud_.origin = origin_near(place, *map_motion_);
  cloud_.points.push_back(as_point(place - cloud_.origin));
  if (has_times_) cloud_.times.push_back(time_unit_ * time);
  if (has_normals_) add_normal({values[3], values[4], values[5]});
}

/// Programs that could not tell a normal write zeros or NaN.
void CloudBuilder::add_normal(const Vector3& normal) {
  const double length = normal.norm();
  constexpr double shortest = 1e-3, longest = 1e3;
  if (!(length > shortest && length < longest)) {
    has_normals_ = false;
    cloud_.normals.clear();
    return;
  }
  cloud_.normals.push_back(as_point(normal / length));
}

Cloud CloudBuilder::finish() {
  if (points_ == 0 && !is_scan_) refuse_cloud(file_, 0, "has no points; give another file");
  if (cloud_.points.empty() && !is_scan_)
    refuse_cloud(file_, 0,
                 fmt::format("none of its {} points has finite coordinates; give another file", points_));
  if (!cloud_.times.empty()) {
    const auto [first, last] = std::ranges::minmax(cloud_.times);
    if (const std::string fault = fault_of_scan_times(first, last); is_scan_ && !fault.empty())
      refuse_cloud(file_, 0, fault + "; write decimals in seconds, or whole numbers in nanoseconds");
    for (double& time : cloud_.times) time -= first;
  }
  return std::move(cloud_);
}

}  // namespace glocal::clouds
