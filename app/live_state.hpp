// Where a robot was last, over a power cycle.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "glocal/global_map.hpp"
#include "glocal/step_result.hpp"

namespace glocal::app {

/// What is kept.
struct LiveState {
  std::string map;       ///< fingerprint() of the map that the pose is on.
  Pose3 map_from_robot;  ///< The last declared pose, and from there on as odometry has it.
  std::optional<PoseCovariance> covariance = {};  ///< When it was declared.
  double stamp = 0.0;                             ///< s; of the last observation.
  double way_since_m = 0.0;                       ///< Driven since a pose was declared last.

  friend bool operator==(const LiveState&, const LiveState&) = default;
};

/// Tells maps apart by their cells and points.
[[nodiscard]] std::string fingerprint(const GlobalMap& map);

/// None if there is no such file. Throws ConfigError for one that is cut short, or no state.
[[nodiscard]] std::optional<LiveState> read_state(const std::filesystem::path& file);
/// Whole or not at all. Throws RunError if it cannot be written.
void write_state(const std::filesystem::path& file, const LiveState& state);

/// Where the robot is thought to be when it is switched on: none if the state is of another map than that
/// with this fingerprint.
[[nodiscard]] std::optional<ExpectedPose> expected_from(const LiveState& state, const std::string& map);

}  // namespace glocal::app
