// A global map in space from the reference poses of a drive of clouds.
#pragma once

#include "glocal/catalog.hpp"
#include "glocal/strategies.hpp"
#include "sources/clouds/cloud_drive.hpp"

namespace glocal::clouds {

/// The mean of the points in each cube that enough clouds have met. Nothing is known to be free.
class CloudDriveMap final : public MapSource {
 public:
  struct Params {
    Params();
    CloudDrive::Params drive;
    double resolution = 0.1;
    int min_clouds = 1;
  };

  CloudDriveMap(const Params& params, const SourceSetup& setup);

  /// Clouds without reference pose are left out. Throws ConfigError where CloudDrive does, and for a map
  /// without points.
  [[nodiscard]] MapData load() override;

 private:
  Params params_;
  SourceSetup setup_;
};
void describe(ParamVisitor& v, CloudDriveMap::Params& p);

}  // namespace glocal::clouds
