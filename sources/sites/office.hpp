// Simulated offices of any size, as map and as drive.
#pragma once

#include <cstdint>
#include <optional>

#include "glocal/catalog.hpp"
#include "glocal/strategies.hpp"
#include "sources/simulation/drive_params.hpp"
#include "sources/simulation/simulation.hpp"

namespace glocal::sites {

/// Which office it is.
struct OfficeParams {
  double side = 50.0;
  std::optional<double> length;
  std::uint64_t number = 1;
  std::uint64_t furniture = 0;  ///< 0: as the number.
};
void describe(ParamVisitor& v, OfficeParams& p);

/// How the robot drives and measures there.
[[nodiscard]] simulation::LaserDriveParams office_drive();

/// Way driven where nothing is said, m: so long that starts are all over the office.
[[nodiscard]] double usual_length(double side);

/// The map that was made of an office before things were moved: its plan, and the free space.
class OfficeMap final : public MapSource {
 public:
  struct Params : OfficeParams {
    double resolution = 0.05;
  };

  explicit OfficeMap(const Params& params) : params_(params) {}
  [[nodiscard]] MapData load() override;

 private:
  Params params_;
};
void describe(ParamVisitor& v, OfficeMap::Params& p);

/// A drive past all its rooms, with a planar laser.
class OfficeDrive final : public ObservationSource {
 public:
  using Params = OfficeParams;

  OfficeDrive(const Params& params, const SourceSetup& setup);
  [[nodiscard]] std::optional<Sample> next() override { return simulation_.next(); }
  [[nodiscard]] std::optional<Recording> recording() const override { return simulation_.recording(); }

 private:
  simulation::Simulation simulation_;
};

}  // namespace glocal::sites
