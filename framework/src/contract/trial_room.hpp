// The room in which strategies are tried out, and what a robot sees of it.
#pragma once

#include <memory>

#include "glocal/catalog.hpp"

namespace glocal {

/// Two rooms at a right angle with a niche, which look like themselves in one pose only. In the plane their
/// walls, every 5 cm a point; in space walls, floor and ceiling, every 20 cm.
class TrialRoom {
 public:
  explicit TrialRoom(Motion motion);

  [[nodiscard]] Motion motion() const { return motion_; }
  [[nodiscard]] const Points& points() const { return map_->points(); }
  [[nodiscard]] StageSetup setup(int threads) const;

  /// Where the robot of local_map() is, which has turned since the map began.
  [[nodiscard]] Pose3 map_from_robot() const;
  [[nodiscard]] LocalMap local_map() const;
  /// What it sees there.
  [[nodiscard]] Observation latest() const;
  /// What it sees `way` m farther along a wall, with the odometry of that.
  [[nodiscard]] Observation along_wall(double way, double odometry_x) const;

 private:
  [[nodiscard]] Points seen_from(const Pose3& map_from_robot) const;

  Motion motion_;
  std::shared_ptr<const GlobalMap> map_;
};

/// Thirty hypotheses around three places, falling score: number i is at place i % 3.
[[nodiscard]] std::vector<Hypothesis> trial_hypotheses();
/// A cluster for each place.
[[nodiscard]] std::vector<Cluster> trial_clusters();
/// A step with one place only, and its cluster: as clear as can be.
[[nodiscard]] StepResult clear_step();

}  // namespace glocal
