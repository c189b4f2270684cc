#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "glocal/error.hpp"
#include "glocal/pose3.hpp"
#include "glocal/voxel_filter.hpp"
#include "sources/clouds/cloud_file.hpp"
#include "sources/simulation/world_grid.hpp"

namespace glocal::simulation {
namespace {

/// Draws surfaces as points on the floor of a world, at most a spacing apart.
class SurfacePainter {
 public:
  SurfacePainter(double floor, double spacing) : floor_(floor), spacing_(spacing) {}

  void draw(const Segment& s) {
    const int steps = count(distance(s.from, s.to));
    for (int i = 0; i <= steps; ++i)
      draw_upright(between(s.from, s.to, static_cast<double>(i) / steps), s.height);
  }

  void draw(const Circle& c) {
    const int steps = count(2.0 * std::numbers::pi * c.radius);
    const int rings = count(c.radius);
    for (int i = 0; i < steps; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / steps;
      const Position towards{std::cos(angle), std::sin(angle)};
      draw_upright({c.centre[0] + c.radius * towards[0], c.centre[1] + c.radius * towards[1]}, c.height);
      for (int ring = 0; ring < rings; ++ring) {
        const double radius = c.radius * ring / rings;
        add({c.centre[0] + radius * towards[0], c.centre[1] + radius * towards[1]}, c.height);
      }
    }
  }

  void draw(const Top& top) {
    const auto& [a, b, c, d] = top.corners;
    const int along = count(distance(a, b));
    const int across = count(distance(a, d));
    for (int i = 0; i <= along; ++i) {
      for (int k = 0; k <= across; ++k) {
        const double s = static_cast<double>(i) / along;
        const double t = static_cast<double>(k) / across;
        add({a[0] + s * (b[0] - a[0]) + t * (d[0] - a[0]), a[1] + s * (b[1] - a[1]) + t * (d[1] - a[1])},
            top.height);
      }
    }
  }

  void add(const Position& place, double height) {
    points_.push_back(as_point({place[0], place[1], floor_ + height}));
  }

  [[nodiscard]] const Points& points() const { return points_; }

 private:
  [[nodiscard]] int count(double length) const {
    return std::max(static_cast<int>(std::ceil(length / spacing_)), 1);
  }
  void draw_upright(const Position& place, double height) {
    const int steps = count(height);
    for (int i = 0; i <= steps; ++i) add(place, height * i / steps);
  }

  double floor_;
  double spacing_;
  Points points_;
};

/// m^2
double area_of(const Shapes& shapes) {
  double area = 0.0;
  for (const Segment& s : shapes.segments) area += distance(s.from, s.to) * s.height;
  for (const Circle& c : shapes.circles) area += std::numbers::pi * c.radius * (2.0 * c.height + c.radius);
  for (const Top& t : shapes.tops) {
    const auto& [a, b, c, d] = t.corners;
    area += distance(a, b) * distance(a, d);
  }
  return area;
}

/// How many points floor and ceiling have: none in a world with a cloud.
double floor_points(const World& world, const OccupancyGrid& plan) {
  if (!world.cloud.text.empty()) return 0.0;
  const auto free = static_cast<double>(std::count(plan.cells.begin(), plan.cells.end(), Cell::free));
  return world.ceiling > 0.0 ? 2.0 * free : free;
}

void add_floor(const World& world, const OccupancyGrid& plan, SurfacePainter& painter) {
  for_each_cell(plan, [&](int column, int row) {
    if (plan.cell(column, row) != Cell::free) return;
    const Pose2 centre = plan.centre(column, row);
    painter.add({centre.x, centre.y}, 0.0);
    if (world.ceiling > 0.0) painter.add({centre.x, centre.y}, world.ceiling);
  });
}

bool is_mapped(const World& world, const Point& p) {
  return std::ranges::none_of(world.unmapped, [&](const UnmappedArea& area) {
    const auto [left, right] = std::minmax(area.corners[0][0], area.corners[1][0]);
    const auto [low, high] = std::minmax(area.corners[0][1], area.corners[1][1]);
    return p.x >= left && p.x <= right && p.y >= low && p.y <= high;
  });
}

}  // namespace

Points surface_points(const World& world, const OccupancyGrid& plan, const std::string& file) {
  const double side = plan.resolution;
  const double spacing = side / 2.0;  // so that no cube on a surface is missed
  const Shapes shapes = shapes_on_map(world);
  constexpr double most_points = 16e6;
  if (!(area_of(shapes) / (spacing * spacing) + floor_points(world, plan) <= most_points)) {
    throw ConfigError(file,
                      fmt::format("its surfaces would have more than 16 million points at a resolution of "
                                  "{} m; raise resolution",
                                  side));
  }
  SurfacePainter things(world.floor, spacing);
  for (const Segment& segment : shapes.segments) things.draw(segment);
  for (const Circle& circle : shapes.circles) things.draw(circle);
  for (const Top& top : shapes.tops) things.draw(top);
  // A cloud has its own floor, which is where its points are.
  SurfacePainter floor(world.floor, spacing);
  Points cloud;
  if (world.cloud.text.empty()) {
    add_floor(world, plan, floor);
  } else {
    cloud = voxel_downsampled(clouds::read_cloud(world.cloud.resolved, {}).points, side);
  }
  Points points;
  for (const Points& part : {voxel_downsampled(things.points(), side), floor.points(), cloud}) {
    for (std::size_t i = 0; i < part.size(); ++i) {
      if (is_mapped(world, part[i])) points.push_back(part[i]);
    }
  }
  return points;
}

}  // namespace glocal::simulation
