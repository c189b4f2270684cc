// What matplotlib has drawn into an SVG file, read back.
#pragma once

#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace glocal::test {

/// In points from the left and the top of the figure, or what they stand for.
struct Place {
  double x = 0.0;
  double y = 0.0;
};

/// Of an axis: place is linear in to_linear(value).
struct Scale {
  std::function<double(double)> to_linear = [](double value) { return value; };
  std::function<double(double)> from_linear = [](double value) { return value; };
};

inline std::size_t find_or_throw(const std::string& svg, const std::string& what, std::size_t from = 0) {
  const std::size_t at = svg.find(what, from);
  if (at == std::string::npos) throw std::invalid_argument("there is no " + what);
  return at;
}

inline std::size_t find_id(const std::string& svg, const std::string& id) {
  return find_or_throw(svg, "<g id=\"" + id + "\">");
}

/// The first number in an attribute that follows: ` x="`.
inline double attribute(const std::string& svg, const std::string& begin, std::size_t from) {
  return std::stod(svg.substr(find_or_throw(svg, begin, from) + begin.size(), 30));
}

/// Vertices of the path with this id.
inline std::vector<Place> vertices(const std::string& svg, const std::string& id) {
  const std::string begin = " d=\"";
  const std::size_t at = find_or_throw(svg, begin, find_id(svg, id)) + begin.size();
  const std::string path = svg.substr(at, svg.find('"', at) - at);
  std::vector<Place> places;
  for (std::size_t i = path.find_first_of("ML"); i != std::string::npos;
       i = path.find_first_of("ML", i + 1)) {
    std::size_t length = 0;
    const double x = std::stod(path.substr(i + 1), &length);
    places.push_back({x, std::stod(path.substr(i + 1 + length))});
  }
  return places;
}

/// Mean of the corners.
inline Place middle(const std::string& svg, const std::string& id) {
  Place sum;
  const std::vector<Place> corners = vertices(svg, id);
  for (const Place& corner : corners) sum = {sum.x + corner.x, sum.y + corner.y};
  const auto n = static_cast<double>(corners.size());
  return {sum.x / n, sum.y / n};
}

/// Places of the dots with this id.
inline std::vector<Place> dots(const std::string& svg, const std::string& id) {
  const std::size_t begin = find_id(svg, id);
  const std::size_t end = svg.find("<g id=", begin + 1);
  std::vector<Place> places;
  for (std::size_t i = svg.find("<use ", begin); i < end; i = svg.find("<use ", i + 1))
    places.push_back({attribute(svg, " x=\"", i), attribute(svg, " y=\"", i)});
  return places;
}

/// A value from a place along an axis, by the numbers beside its first and its last tick.
class Axis {
 public:
  /// `axis` is x or y; `axes` is what the file says of the axes.
  Axis(const std::string& axes, const std::string& axis, Scale scale) : scale_(std::move(scale)) {
    const std::string begin = "<g id=\"" + axis + "tick_";
    const auto read = [&](std::size_t tick, double& value, double& place) {
      place = attribute(axes, " " + axis + "=\"", find_or_throw(axes, "<use ", tick));
      value = scale_.to_linear(attribute(axes, "<!-- ", tick));
    };
    read(find_or_throw(axes, begin), value_, place_);
    double value = 0.0;
    double place = 0.0;
    read(axes.rfind(begin), value, place);
    if (place == place_) throw std::invalid_argument("the axis has a single tick");
    per_place_ = (value - value_) / (place - place_);
  }

  [[nodiscard]] double at(double place) const {
    return scale_.from_linear(value_ + per_place_ * (place - place_));
  }

 private:
  Scale scale_;
  double value_ = 0.0, place_ = 0.0, per_place_ = 0.0;
};

/// Values of the curve with this id; x is linear.
inline std::vector<Place> curve(const std::string& svg, const std::string& id, const Scale& y_scale = {}) {
  const std::string begin = "<g id=\"axes_";
  const std::size_t axes = svg.rfind(begin, find_id(svg, id));
  const Axis x(svg.substr(svg.rfind(begin)), "x", {});  // the lowest of those that share it has the numbers
  const Axis y(svg.substr(axes, svg.find(begin, axes + 1) - axes), "y", y_scale);
  std::vector<Place> values;
  for (const Place& place : vertices(svg, id)) values.push_back({x.at(place.x), y.at(place.y)});
  return values;
}

}  // namespace glocal::test
