// Single scans at random places of a known map.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "glocal/catalog.hpp"
#include "glocal/occupancy_grid.hpp"
#include "glocal/strategies.hpp"
#include "sources/ros_map/ros_map.hpp"
#include "sources/simulation/laser.hpp"
#include "sources/simulation/occupancy_ray.hpp"

namespace glocal::simulation {

/// Poses drawn uniformly in the free cells of a map, headings too, and a scan cast through the map's cells at
/// each. Odometry means nothing: every scan is a segment of its own.
class RandomScans final : public ObservationSource {
 public:
  struct Params {
    ros_map::RosMap::Params map;
    int count = 100;
    double clearance = 0.3;
    double max_unknown = unknown_rim;  ///< As in LaserDriveParams.
    LaserParams laser;
  };

  /// Throws ConfigError where ros_map::RosMap does, and for a map without a cell that is free and clear.
  RandomScans(const Params& params, const SourceSetup& setup);
  /// On a map that is in no file.
  RandomScans(const Params& params, MapData map, std::uint64_t seed);

  [[nodiscard]] std::optional<Sample> next() override;

 private:
  [[nodiscard]] Pose2 draw_pose() const;

  Params params_;
  MapData map_;
  std::vector<std::size_t> clear_cells_;  ///< Indexes of the cells a pose may lie in.
  carmen::LogParams scan_limits_;
  Rng rng_;
  std::size_t next_ = 0;
};
void describe(ParamVisitor& v, RandomScans::Params& p);

}  // namespace glocal::simulation
