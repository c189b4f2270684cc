// Simulated observations, and the map that goes with them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "glocal/catalog.hpp"
#include "glocal/strategies.hpp"
#include "sources/simulation/drive_simulator.hpp"
#include "sources/simulation/world.hpp"

namespace glocal::simulation {

/// A drive through a simulated world or a map, with a planar laser.
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
  carmen::LogParams scan_limits_;
  DriveSimulator simulator_;
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
