#include "glocal/prior.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "glocal/extent.hpp"

namespace glocal {
namespace {

/// How far a value is outside of [low, high].
double beyond(double value, double low, double high) {
  return std::max({low - value, value - high, 0.0});
}

/// Whether a free cell has a part in the region.
bool has_free_cell(const OccupancyGrid& grid, const StartRegion& region) {
  const Pose2 middle = inverse(grid.map_from_grid) * Pose2{*region.x, *region.y, 0.0};
  const StartRegion in_grid{middle.x, middle.y, region.radius};
  const double side = grid.resolution;
  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      if (grid.cell(column, row) == Cell::free &&
          in_grid.meets(column * side, row * side, (column + 1) * side, (row + 1) * side))
        return true;
    }
  }
  return false;
}

bool has_point(const Points& points, const StartRegion& region, double reach) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (std::hypot(points.x[i] - *region.x, points.y[i] - *region.y) <= *region.radius + reach) return true;
  }
  return false;
}

std::string text_of(const StartRegion& region) {
  return fmt::format("within {:g} m of x {:.10g}, y {:.10g}", *region.radius, *region.x, *region.y);
}

std::string range_of(const std::vector<float>& values, double origin) {
  const Extent extent = extent_of(values);
  return fmt::format("from {:.1f} m to {:.1f} m", origin + extent.low, origin + extent.high);
}

}  // namespace

void describe(ParamVisitor& v, StartRegion& p) {
  v.field("x", p.x,
          {.doc = "Middle of the region, in the map; auto: no region.",
           .unit = "m",
           .min = -farthest_m,
           .max = farthest_m});
  v.field("y", p.y,
          {.doc = "Middle of the region, in the map; auto: no region.",
           .unit = "m",
           .min = -farthest_m,
           .max = farthest_m});
  v.field("radius", p.radius,
          {.doc = "How far from its middle the region reaches; auto: no region.",
           .unit = "m",
           .max = farthest_m,
           .above = 0.0});
  v.require(p.x.has_value() == p.radius.has_value() && p.y.has_value() == p.radius.has_value(), "",
            "x, y and radius must be given together");
}

bool StartRegion::meets(double low_x, double low_y, double high_x, double high_y) const {
  return std::hypot(beyond(*x, low_x, high_x), beyond(*y, low_y, high_y)) <= *radius;
}

void describe(ParamVisitor& v, StartHeading& p) {
  v.field("deg", p.deg,
          {.doc = "Middle of the range of headings, in the map; auto: any heading.",
           .unit = "deg",
           .min = -360.0,
           .max = 360.0});
  v.field("width_deg", p.width_deg,
          {.doc = "How wide the range is, half of it on either side; auto: any heading.",
           .unit = "deg",
           .max = 360.0,
           .above = 0.0});
  v.require(p.deg.has_value() == p.width_deg.has_value(), "", "deg and width_deg must be given together");
}

void describe(ParamVisitor& v, Prior& p) {
  v.field("region", p.region, {.doc = "Where on the map the robot was when the trial began."});
  v.field("heading", p.heading, {.doc = "Where the robot looked when the trial began."});
}

bool Prior::allows(const Pose3& map_from_start) const {
  const Pose3& start = map_from_start;
  if (region.is_given() && !region.meets(start.x, start.y, start.x, start.y)) return false;
  if (!heading.is_given()) return true;
  const double turned = std::abs(wrap_angle(start.heading() - radians(*heading.deg)));
  return degrees(turned) <= *heading.width_deg / 2.0;
}

Prior shifted(Prior prior, const Vector3& by) {
  if (!prior.region.is_given()) return prior;
  *prior.region.x += by.x();
  *prior.region.y += by.y();
  return prior;
}

std::string to_string(const Prior& prior) {
  std::string text = "starts";
  if (prior.region.is_given()) text += " " + text_of(prior.region);
  if (prior.heading.is_given()) {
    text +=
        fmt::format(" with headings of {:g} ± {:g} deg", *prior.heading.deg, *prior.heading.width_deg / 2.0);
  }
  return text;
}

std::optional<std::string> why_nowhere(const Prior& prior, const GlobalMap& map) {
  constexpr double reach = 100.0;  // m
  if (!prior.region.is_given()) return std::nullopt;
  if (!map.parts().empty())
    return "a region is on one map, and there are several; leave it out, or take the one map";
  const StartRegion region = shifted(prior, -map.origin()).region;
  const bool has_cells = !map.grid().cells.empty();
  if (has_cells ? has_free_cell(map.grid(), region) : has_point(map.points(), region, reach))
    return std::nullopt;
  return fmt::format("the map has nothing {}: {}; its points have x {} and y {}, so move the region there",
                     text_of(prior.region),
                     has_cells ? "no free cell" : fmt::format("no point is nearer than {:g} m", reach),
                     range_of(map.points().x, map.origin().x()), range_of(map.points().y, map.origin().y()));
}

void StartInLocalMap::follow(const LocalMap& local, const Pose3& odom_from_robot) {
  if (!last_) {
    local_from_start_ = local.local_from_robot;
  } else if (last_->epoch != local.epoch) {
    const Pose3 robot_from_last = inverse(odom_from_robot) * last_->odom_from_robot;
    local_from_start_ =
        local.local_from_robot * robot_from_last * inverse(last_->local_from_robot) * local_from_start_;
  }
  last_ = {local.local_from_robot, odom_from_robot, local.epoch};
}

}  // namespace glocal
