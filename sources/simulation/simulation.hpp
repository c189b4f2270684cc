// Simulated observations, and the map that goes with them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "glocal/catalog.hpp"
#include "glocal/strategies.hpp"
#include "sources/carmen/carmen_parser.hpp"
#include "sources/carmen/log_drive.hpp"
#include "sources/simulation/driving_robot.hpp"
#include "sources/simulation/near_shapes.hpp"
#include "sources/simulation/planned_drive.hpp"
#include "sources/simulation/world.hpp"

namespace glocal::simulation {

/// A drive through a simulated world or a map, with a planar laser. Rays that meet nothing within the laser's
/// range read max_range, those that are lost in unknown cells of a map 0.
class Simulation final : public ObservationSource {
 public:
  using Params = LaserDriveParams;

  /// Throws ConfigError where planned_drive() does.
  Simulation(const Params& params, const SourceSetup& setup);
  /// Of a world that is in no file, along its way points.
  Simulation(const Params& params, World world, std::uint64_t seed);

  [[nodiscard]] std::optional<Sample> next() override;
  /// As a CARMEN log.
  [[nodiscard]] std::optional<Recording> recording() const override;

 private:
  Simulation(const Params& params, PlannedDrive drive, std::uint64_t seed);

  [[nodiscard]] carmen::CarmenScan measured(const DriveStep& step) const;

  LaserParams laser_;
  carmen::LogParams scan_limits_;
  double max_unknown_;
  World world_;
  std::optional<OccupancyGrid> map_;
  Vector3 origin_;  ///< What all places but those of scans are relative to.
  NearShapes reality_;
  DrivingRobot robot_;
};

/// The map of a simulated world: its outlines, one cell thick, and the free space they enclose; or its
/// surfaces in space, over the same plan.
class SimulatedMap final : public MapSource {
 public:
  struct Params {
    FilePath world;
    double resolution = 0.03;
    std::string points = "plan";
  };

  SimulatedMap(const Params& params, const SourceSetup& setup);

  /// Cells are centred on multiples of the resolution, so that walls that stand there are met exactly. Throws
  /// ConfigError for a faulty world, or one without anything on the map.
  [[nodiscard]] MapData load() override;

 private:
  Params params_;
  std::function<void(const std::filesystem::path&)> note_input_;
};
void describe(ParamVisitor& v, SimulatedMap::Params& p);

}  // namespace glocal::simulation
