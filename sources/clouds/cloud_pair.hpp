// A pair of clouds from a list: one is the map, the other what the robot sees of it.
#pragma once

#include <optional>

#include "glocal/catalog.hpp"
#include "glocal/strategies.hpp"
#include "sources/clouds/pair_list.hpp"
#include "sources/clouds/point_cloud_map.hpp"

namespace glocal::clouds {

/// Which pair it is.
struct CloudPairParams {
  FilePath list;
  int number = 1;
};
void describe(ParamVisitor& v, CloudPairParams& p);

/// The target, as a map. The pair's pose is that of the source's sensor in it.
class CloudPairMap final : public MapSource {
 public:
  using Params = CloudPairParams;

  /// Throws ConfigError for a list that cannot be read or has no such pair.
  CloudPairMap(const Params& params, const SourceSetup& setup);
  [[nodiscard]] MapData load() override { return target_.load(); }

 private:
  PointCloudMap target_;
};

/// The source, as the only scan of a drive.
class CloudPairScan final : public ObservationSource {
 public:
  using Params = CloudPairParams;

  /// Throws ConfigError for a list that cannot be read or has no such pair.
  CloudPairScan(const Params& params, const SourceSetup& setup);
  [[nodiscard]] std::optional<Sample> next() override;

 private:
  CloudPair pair_;
  bool is_read_ = false;
};

}  // namespace glocal::clouds
