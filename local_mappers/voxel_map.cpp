#include "local_mappers/voxel_map.hpp"

#include <cmath>
#include <utility>

namespace glocal::local_mappers {
namespace {

constexpr double bytes_per_mb = 1e6;

std::size_t tiles_in(int memory_mb) {
  return static_cast<std::size_t>(memory_mb * bytes_per_mb / static_cast<double>(PointGrid::tile_bytes()));
}

/// The normal of `n` hits whose mean normal is `mean`, and one more. A normal from the other side of a thin
/// wall is left out.
Point average_normal(const Point& mean, float n, const Point& normal) {
  const float cosine = mean.x * normal.x + mean.y * normal.y;
  if (cosine < 0.0F) return mean;
  const float x = mean.x * n + normal.x;
  const float y = mean.y * n + normal.y;
  const float length = std::sqrt(x * x + y * y);
  if (length <= 0.0F) return {};
  return {x / length, y / length, 0.0F};
}

}  // namespace

void describe(ParamVisitor& v, VoxelParams& p) {
  v.field("resolution", p.resolution,
          {.doc = "Side of the voxels that hold one point each.",
           .unit = "m",
           .max = 1.0,
           .above = 0.001,
           .audience = Audience::tuner});
}

int cells_in(double metres, double resolution) {
  return static_cast<int>(std::ceil(metres / resolution));
}

LocalScan::LocalScan(const Points& robot_hits, const Points& robot_normals, const Pose2& local_from_robot) {
  const Transform transform(local_from_robot);
  const Transform rotation({0.0, 0.0, local_from_robot.theta});
  hits.reserve(robot_hits.size());
  normals.reserve(robot_hits.size());
  for (std::size_t i = 0; i < robot_hits.size(); ++i) {
    hits.push_back(transform(robot_hits[i]));
    normals.push_back(rotation(robot_normals[i]));
  }
}

VoxelMap::VoxelMap(const VoxelParams& params, int reach, double sigma)
    : params_(params), grid_(params.resolution, reach, sigma, tiles_in(params.memory_mb)) {}

bool VoxelMap::holds_robot() const {
  return grid_.contains(static_cast<float>(robot_.x), static_cast<float>(robot_.y));
}

void VoxelMap::move_robot(const Pose2& local_from_robot) {
  robot_ = local_from_robot;
  map_.local_from_robot = local_from_robot;
}

void VoxelMap::move_robot(const Pose3& local_from_robot) {
  robot_ = seen_from_above(local_from_robot);
  map_.local_from_robot = local_from_robot;
}

void VoxelMap::clear() {
  map_.points.clear();
  map_.normals.clear();
  map_.ends.clear();
  hits_.clear();
  next_above_.clear();
  grid_.clear();
}

void VoxelMap::start_over() {
  clear();
  move_robot(Pose2{});
  ++map_.epoch;
}

void VoxelMap::reset() {
  start_over();
  map_.epoch = 0;
}

void VoxelMap::add(const LocalScan& scan) {
  for (std::size_t i = 0; i < scan.hits.size(); ++i) {
    const Point p = scan.hits[i];
    if (!grid_.contains(p.x, p.y)) continue;
    if (scan.normals.empty()) {
      add_hit(p, nullptr);
    } else {
      const Point normal = scan.normals[i];
      add_hit(p, &normal);
    }
  }
  map_.ends.push_back(map_.points.size());
}

void VoxelMap::add_hit(const Point& p, const Point* normal) {
  const GridCell cell = grid_.cell(p.x, p.y);
  const int found = find_point(cell, p.z);
  if (found != PointGrid::none) {
    average_into(static_cast<std::size_t>(found), p, normal);
  } else {
    append_point(cell, p, normal);
  }
}

int VoxelMap::find_point(GridCell cell, float z) const {
  const auto layer = [this](float height) {
    return std::floor(height / static_cast<float>(params_.resolution));
  };
  const auto is_in_layer = [&](float height) { return height == z || layer(height) == layer(z); };
  int i = grid_.inside(cell);
  while (i != PointGrid::none && !is_in_layer(map_.points.z[static_cast<std::size_t>(i)])) {
    i = next_above_[static_cast<std::size_t>(i)];
  }
  return i;
}

void VoxelMap::append_point(GridCell cell, const Point& p, const Point* normal) {
  const std::size_t index = map_.points.size();
  if (index >= PointGrid::max_points) return;
  const int first = grid_.inside(cell);
  std::int32_t next = PointGrid::none;
  if (first != PointGrid::none) {
    // The column's first point stays the one that scans are matched to; others are chained behind it.
    next = std::exchange(next_above_[static_cast<std::size_t>(first)], static_cast<std::int32_t>(index));
  } else if (!grid_.insert(cell, index)) {
    return;
  }
  map_.points.push_back(p);
  if (normal != nullptr) map_.normals.push_back(*normal);
  hits_.push_back(1);
  next_above_.push_back(next);
}

void VoxelMap::average_into(std::size_t index, const Point& p, const Point* normal) {
  if (hits_[index] >= params_.cell_hits) return;
  const auto n = static_cast<float>(hits_[index]++);
  const Point mean = map_.points[index];
  const auto average = [n](float a, float b) { return a + (b - a) / (n + 1.0F); };
  map_.points.set(index, {average(mean.x, p.x), average(mean.y, p.y), average(mean.z, p.z)});
  if (normal != nullptr) map_.normals.set(index, average_normal(map_.normals[index], n, *normal));
}

}  // namespace glocal::local_mappers
