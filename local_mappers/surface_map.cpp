#include "local_mappers/surface_map.hpp"

#include <algorithm>
#include <cmath>

#include "glocal/point_spread.hpp"

namespace glocal::local_mappers {
namespace {

/// Largest ratio of the variances across and along a surface; rougher places have no normal.
constexpr double max_roughness = 0.2;

float squared_distance(const Point& a, const Point& b) {
  return dot(a - b, a - b);
}

/// How far a coordinate is from the block `block`, m.
float gap_to_block(float value, std::int32_t block, float side) {
  const float low = static_cast<float>(block) * side;
  return std::max({low - value, value - (low + side), 0.0F});
}

}  // namespace

void describe(ParamVisitor& v, SurfaceMapParams& p) {
  v.field("resolution", p.resolution,
          {.doc = "Side of the cubes that hold one point each.",
           .unit = "m",
           .max = 10.0,
           .above = 0.001,
           .audience = Audience::tuner});
  v.field("normal_radius", p.normal_radius,
          {.doc = "A point's normal is computed from the points of the map within this distance: a few times "
                  "what is between neighbouring rings of a scan.",
           .unit = "m",
           .max = 100.0,
           .above = 0.0,
           .audience = Audience::tuner});
  v.require(p.normal_radius >= p.resolution, "normal_radius", "must not be below resolution");
  v.require(p.normal_radius <= 100.0 * p.resolution, "normal_radius", "must be at most 100 times resolution");
}

SurfaceMap::SurfaceMap(const SurfaceMapParams& params)
    : params_(params),
      // Of smaller blocks a hit without a partner near by would look into too many.
      cells_in_block_(static_cast<std::int32_t>(
          std::ceil(std::max(params.normal_radius, 0.5) / params.resolution - 1e-9))),
      block_side_(static_cast<float>(cells_in_block_ * params.resolution)) {}

SurfaceMap::Cell SurfaceMap::cell_of(const Point& p) const {
  const auto cell = [&](float value) {
    return static_cast<std::int32_t>(std::floor(value / params_.resolution));
  };
  return {cell(p.x), cell(p.y), cell(p.z)};
}

SurfaceMap::Block SurfaceMap::block_of(const Cell& cell) const {
  const auto block = [&](std::int32_t index) {
    return (index >= 0 ? index : index - cells_in_block_ + 1) / cells_in_block_;
  };
  return {block(cell[0]), block(cell[1]), block(cell[2])};
}

void SurfaceMap::add(const Points& hits, const Point& sensor, double way) {
  const auto is_within = [](float value) { return std::abs(value) <= reach; };
  std::vector<std::size_t> changed;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const Point p = hits[i];
    if (!is_within(p.x) || !is_within(p.y) || !is_within(p.z)) continue;
    const std::size_t index = add_hit(p);
    seen_[index].last = observations_;
    seen_[index].way = way;
    if (seen_[index].hits < static_cast<std::uint32_t>(params_.cell_hits)) {
      const auto share = 1.0F / static_cast<float>(++seen_[index].hits);
      const Point mean = map_.points[index];
      map_.points.set(index, mean + share * (p - mean));
      changed.push_back(index);
    }
  }
  ++observations_;
  map_.ends.push_back(map_.points.size());
  update_normals(changed, sensor);
}

std::size_t SurfaceMap::add_hit(const Point& p) {
  const Cell cell = cell_of(p);
  const std::uint32_t number = numbers_.find(block_of(cell));
  if (number != BlockNumbers::none) {
    for (const std::uint32_t index : blocks_[number])
      if (cell_of(map_.points[index]) == cell) return index;
  }
  map_.points.push_back(p);
  map_.normals.push_back({});
  seen_.emplace_back();
  index_point(map_.points.size() - 1);
  return map_.points.size() - 1;
}

void SurfaceMap::index_point(std::size_t index) {
  const std::uint32_t number = numbers_.find_or_add(block_of(cell_of(map_.points[index])));
  if (number == blocks_.size()) blocks_.emplace_back();
  blocks_[number].push_back(static_cast<std::uint32_t>(index));
}

void SurfaceMap::rebuild_index() {
  numbers_.clear();
  blocks_.clear();
  for (std::size_t i = 0; i < map_.points.size(); ++i) index_point(i);
}

void SurfaceMap::forget(std::size_t scans, double way) {
  const auto is_kept = [&](std::size_t i) {
    return seen_[i].way >= way && observations_ - seen_[i].last <= scans;
  };
  std::size_t kept = 0;
  std::size_t i = 0;
  for (std::size_t& end : map_.ends) {
    for (; i < end; ++i) {
      if (!is_kept(i)) continue;
      map_.points.set(kept, map_.points[i]);
      map_.normals.set(kept, map_.normals[i]);
      seen_[kept++] = seen_[i];
    }
    end = kept;
  }
  if (kept == i) return;
  for (auto* points : {&map_.points, &map_.normals}) {
    points->x.resize(kept);
    points->y.resize(kept);
    points->z.resize(kept);
  }
  seen_.resize(kept);
  const auto first = std::ranges::find_if(map_.ends, [](std::size_t end) { return end > 0; });
  map_.ends.erase(map_.ends.begin(), first == map_.ends.end() ? first - 1 : first);
  rebuild_index();
}

void SurfaceMap::start_over() {
  const int epoch = map_.epoch + 1;
  map_ = {};
  map_.epoch = epoch;
  seen_.clear();
  observations_ = 0;
  rebuild_index();
}

void SurfaceMap::reset() {
  start_over();
  map_.epoch = 0;
}

std::optional<std::size_t> SurfaceMap::nearest(const Point& p, double within) const {
  const Block centre = block_of(cell_of(p));
  const auto blocks = static_cast<std::int32_t>(std::ceil(within / block_side_));
  auto least = static_cast<float>(within * within);
  std::optional<std::size_t> found;
  const auto look_into = [&](const Block& block) {
    const std::uint32_t number = numbers_.find(block);
    if (number == BlockNumbers::none) return;
    for (const std::uint32_t index : blocks_[number]) {
      const float squared = squared_distance(map_.points[index], p);
      if (squared < least || (squared == least && (!found || index < *found))) {
        least = squared;
        found = index;
      }
    }
  };
  look_into(centre);  // First, as little is left to look at afterwards.
  for (std::int32_t x = centre[0] - blocks; x <= centre[0] + blocks; ++x) {
    const float dx = gap_to_block(p.x, x, block_side_);
    if (dx * dx > least) continue;
    for (std::int32_t y = centre[1] - blocks; y <= centre[1] + blocks; ++y) {
      const float dy = gap_to_block(p.y, y, block_side_);
      if (dx * dx + dy * dy > least) continue;
      for (std::int32_t z = centre[2] - blocks; z <= centre[2] + blocks; ++z) {
        const float dz = gap_to_block(p.z, z, block_side_);
        const Block block{x, y, z};
        if (dx * dx + dy * dy + dz * dz <= least && block != centre) look_into(block);
      }
    }
  }
  return found;
}

void SurfaceMap::update_normals(const std::vector<std::size_t>& points, const Point& sensor) {
  // Of all points in these blocks: their neighbours have changed.
  std::vector<std::uint32_t> numbers;
  numbers.reserve(points.size());
  for (const std::size_t i : points) numbers.push_back(numbers_.find(block_of(cell_of(map_.points[i]))));
  std::ranges::sort(numbers);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  for (const std::uint32_t number : numbers) {
    const Points around = points_around(blocks_[number].front());
    for (const std::uint32_t i : blocks_[number]) {
      const Point before = map_.normals[i];
      const Point p = map_.points[i];
      const bool had_one = before != Point{};
      const Point towards = had_one ? before : sensor - p;
      const Point n = normal_at(p, around);
      map_.normals.set(i, dot(n, towards) < 0.0F ? -1.0F * n : n);
    }
  }
}

Points SurfaceMap::points_around(std::uint32_t index) const {
  const Block centre = block_of(cell_of(map_.points[index]));
  Points around;
  for (std::int32_t x = centre[0] - 1; x <= centre[0] + 1; ++x) {
    for (std::int32_t y = centre[1] - 1; y <= centre[1] + 1; ++y) {
      for (std::int32_t z = centre[2] - 1; z <= centre[2] + 1; ++z) {
        const std::uint32_t number = numbers_.find({x, y, z});
        if (number == BlockNumbers::none) continue;
        for (const std::uint32_t i : blocks_[number]) around.push_back(map_.points[i]);
      }
    }
  }
  return around;
}

Point SurfaceMap::normal_at(const Point& p, const Points& around) const {
  constexpr double fewest = 6.0;
  // Points of a single ring are on a line: that says little.
  constexpr double thinnest_width = 0.05;
  const auto radius_squared = static_cast<float>(params_.normal_radius * params_.normal_radius);
  PointSums<double> sums;
  for (std::size_t i = 0; i < around.size(); ++i) {
    const Point q = around[i];
    if (squared_distance(p, q) > radius_squared) continue;
    sums.add(double{q.x} - p.x, double{q.y} - p.y, double{q.z} - p.z);
  }
  if (sums.size() < fewest) return {};
  return sums.plane_normal(thinnest_width, max_roughness).value_or(Point{});
}

}  // namespace glocal::local_mappers
