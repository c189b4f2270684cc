// Maps that were recorded as messages.
#pragma once

#include <string>

#include "glocal/catalog.hpp"
#include "glocal/strategies.hpp"

namespace glocal::bags {

/// An occupancy grid (nav_msgs/OccupancyGrid) of a recording: the last one of its topic.
class BagMap final : public MapSource {
 public:
  struct Params {
    FilePath path;
    bool strict = false;
    std::string topic;
  };

  BagMap(const Params& params, const SourceSetup& setup) : params_(params), setup_(setup) {}

  /// Each occupied cell's centre is a point. Throws ConfigError where Recording does, for a recording without
  /// such a topic or with several, and for a grid that is damaged, tilted or without occupied cell.
  [[nodiscard]] MapData load() override;

 private:
  Params params_;
  SourceSetup setup_;
};
void describe(ParamVisitor& v, BagMap::Params& p);

}  // namespace glocal::bags
