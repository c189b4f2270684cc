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
    double occupied_thresh = 0.65;
    double free_thresh = 0.196;
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

/// Cells more likely to be occupied than `occupied` are, less likely ones than `free` are free.
struct CellThresholds {
  double occupied = 0.65, free = 0.196;  ///< As map_server has them.
};

/// The map of a message; each occupied cell's centre is a point. Throws ConfigError, naming `source` and
/// topic, for a grid that is too large, tilted or without occupied cell.
[[nodiscard]] MapData map_of(const GridMessage& grid, const CellThresholds& thresholds,
                             const std::string& source, const std::string& topic);

}  // namespace glocal::bags
