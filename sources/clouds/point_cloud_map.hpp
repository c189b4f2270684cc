// Maps that are clouds of points.
#pragma once

#include "glocal/catalog.hpp"
#include "glocal/strategies.hpp"
#include "sources/clouds/cloud.hpp"

namespace glocal::clouds {

/// A map without cells: nothing is known to be free.
class PointCloudMap final : public MapSource {
 public:
  struct Params {
    FilePath path;
    double unit = 1.0;
    double voxel_size = 0.0;
    FilePath trajectory;
  };

  PointCloudMap(const Params& params, const SourceSetup& setup);

  /// Throws ConfigError for files that are no cloud or no trajectory; warns of what is odd about the cloud.
  [[nodiscard]] MapData load() override;

 private:
  Params params_;
  Motion motion_;
  Warn warn_;
};
void describe(ParamVisitor& v, PointCloudMap::Params& p);

/// How far apart neighbouring points lie, m: the median distance from a point to the nearest that is
/// elsewhere, of some of the points. 0 if all are in one place.
[[nodiscard]] double typical_spacing(const Points& points);

}  // namespace glocal::clouds
