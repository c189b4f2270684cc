// The map that a robot's map server sends, and maps as it would send them.
#pragma once

#include <string>

#include "glocal/catalog.hpp"
#include "glocal/message_link.hpp"
#include "glocal/strategies.hpp"
#include "sources/bags/messages.hpp"

namespace glocal::live {

class LiveMap final : public MapSource {
 public:
  struct Params {
    /// Of the link; outlives all that is made of it.
    const Registry<MessageLink, SourceSetup>* links = nullptr;
    StrategyChoice link = {};
    std::string topic = {};
  };

  LiveMap(const Params& params, const SourceSetup& setup) : params_(params), setup_(setup) {}

  /// Waits for the map. Throws ConfigError if none comes within 10 s, with the topics that there are, or the
  /// setup says to stop, and where map_of() does.
  [[nodiscard]] MapData load() override;

 private:
  Params params_;
  SourceSetup setup_;
};
void describe(ParamVisitor& v, LiveMap::Params& p);

/// The same on a link that others use, too; empty: the only topic with a map. Messages of other topics are
/// passed over.
[[nodiscard]] MapData live_map(MessageLink& link, std::string topic, const std::function<bool()>& is_stopped);

/// A map as a message: nav_msgs/OccupancyGrid, or sensor_msgs/PointCloud2 of one without cells.
[[nodiscard]] LiveMessage map_message(const MapData& map, std::string topic, const bags::Header& header);

}  // namespace glocal::live
