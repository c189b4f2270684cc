// Maps that were recorded as messages.
#pragma once

#include <string>

#include "glocal/catalog.hpp"
#include "glocal/strategies.hpp"
#include "sources/bags/messages.hpp"

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

/// The map of a message; each occupied cell's centre is a point. Throws ConfigError, naming `source` and
/// topic, for a grid that is too large, tilted or without occupied cell.
[[nodiscard]] MapData map_of(const GridMessage& grid, const std::string& source, const std::string& topic);

}  // namespace glocal::bags
