#include "contract/trial_room.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace glocal {
namespace {

using Corner = std::array<double, 2>;

constexpr std::array<Corner, 11> corners_of_room = {
    {{0, 0}, {8, 0}, {8, 3}, {7, 3}, {7, 3.6}, {8, 3.6}, {8, 5}, {4, 5}, {4, 9}, {0, 9}, {0, 0}}};
constexpr double height_of_room = 2.4;  // m

/// A wall's points at a height.
void add_walls(Points& points, double spacing, double z) {
  for (std::size_t i = 1; i < corners_of_room.size(); ++i) {
    const auto& [x0, y0] = corners_of_room[i - 1];
    const auto& [x1, y1] = corners_of_room[i];
    const int n = static_cast<int>(std::lround(std::hypot(x1 - x0, y1 - y0) / spacing));
    for (int k = 0; k < n; ++k) {
      const double share = static_cast<double>(k) / n;
      points.push_back(as_point({std::lerp(x0, x1, share), std::lerp(y0, y1, share), z}));
    }
  }
}

void add_floor(Points& points, double spacing, double z) {
  for (double x = spacing; x < 8.0; x += spacing) {
    for (double y = spacing; y < (x < 4.0 ? 9.0 : 5.0); y += spacing) points.push_back(as_point({x, y, z}));
  }
}

MapData planar_room() {
  constexpr double cell = 0.1;  // m
  MapData data;
  add_walls(data.points, 0.05, 0.0);
  data.grid = {{-0.05, -0.05, 0.0}, cell, 82, 92, PackedCells(std::size_t{82} * 92, Cell::free)};
  return data;
}

MapData room_in_space() {
  constexpr double spacing = 0.2;  // m
  MapData data;
  for (double z = spacing; z < height_of_room; z += spacing) add_walls(data.points, spacing, z);
  add_floor(data.points, spacing, 0.0);
  add_floor(data.points, spacing, height_of_room);
  data.resolution = spacing;
  return data;
}

}  // namespace

TrialRoom::TrialRoom(Motion motion)
    : motion_(motion),
      map_(std::make_shared<const GlobalMap>(motion == Motion::planar ? planar_room() : room_in_space())) {}

StageSetup TrialRoom::setup(int threads) const {
  StageSetup setup{map_, threads};
  setup.contact_epsilon = motion_ == Motion::planar ? 0.1 : 0.2;
  setup.motion = motion_;
  return setup;
}

Pose3 TrialRoom::map_from_robot() const {
  const Pose2 seen_from_above{5.5, 2.5, 0.7};
  if (motion_ == Motion::planar) return seen_from_above;
  return {{5.5, 2.5, 1.2}, turn_about_z(0.7)};
}

LocalMap TrialRoom::local_map() const {
  LocalMap local;
  local.local_from_robot = Pose2{1.5, -0.7, 0.9};
  local.points = moved(seen_from(map_from_robot()), local.local_from_robot);
  local.ends = {local.points.size()};
  return local;
}

Observation TrialRoom::latest() const {
  Observation observation;
  observation.scan.hits = seen_from(map_from_robot());
  observation.odom_from_robot = local_map().local_from_robot;
  return observation;
}

Observation TrialRoom::along_wall(double way, double odometry_x) const {
  Observation observation;
  const double z = motion_ == Motion::planar ? 0.0 : 1.2;
  observation.scan.hits = seen_from(Pose3(Vector3{2.0 + way, 2.0, z}));
  observation.odom_from_robot.x = odometry_x;
  observation.stamp = way;
  return observation;
}

Points TrialRoom::seen_from(const Pose3& map_from_robot) const {
  constexpr float reach = 3.5F;  // m
  const Points all = moved(points(), inverse(map_from_robot));
  Points seen;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (std::hypot(all.x[i], all.y[i], all.z[i]) <= reach) seen.push_back(all[i]);
  }
  return seen;
}

std::vector<Hypothesis> trial_hypotheses() {
  Rng rng(3);
  std::vector<Hypothesis> hypotheses;
  for (int i = 0; i < 30; ++i) {
    const Pose2 pose{5.0 * (i % 3) + rng.normal(0.02), rng.normal(0.02), wrap_angle(3.1 + rng.normal(0.02))};
    const double score = 0.9 - 0.01 * i;
    hypotheses.push_back({.map_from_local = pose, .map_from_robot = pose, .quality = score, .score = score});
  }
  return hypotheses;
}

std::vector<Cluster> trial_clusters() {
  std::vector<Cluster> clusters(3);
  const std::vector<Hypothesis> hypotheses = trial_hypotheses();
  for (std::size_t i = 0; i < hypotheses.size(); ++i) clusters[i % 3].members.push_back(i);
  for (std::size_t k = 0; k < clusters.size(); ++k) {
    clusters[k].map_from_robot = hypotheses[k].map_from_robot;
    clusters[k].variance_x = clusters[k].variance_y = clusters[k].variance_theta = 0.0004;
  }
  return clusters;
}

StepResult clear_step() {
  StepResult step;
  const std::vector<Hypothesis> hypotheses = trial_hypotheses();
  Cluster cluster = trial_clusters().front();
  for (std::size_t& member : cluster.members) {
    step.hypotheses.push_back(hypotheses[member]);
    member = step.hypotheses.size() - 1;
  }
  step.clusters = {std::move(cluster)};
  step.ratings = {{0.9, 1.0}};
  return step;
}

}  // namespace glocal
