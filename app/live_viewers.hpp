// What viewers get of a live localization.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "app/foxglove_server.hpp"
#include "glocal/global_map.hpp"
#include "glocal/message_link.hpp"
#include "sources/bags/messages.hpp"

namespace glocal::app {

/// Hands on a link's messages to viewers, and the map before them. Maps and the mounts of sensors are kept
/// for those who come late. Of several maps, where each of them lies is told as if it were a mount.
class LiveViewers {
 public:
  /// The map goes to this topic, in this frame. `server` must outlive this.
  LiveViewers(FoxgloveServer& server, std::shared_ptr<const GlobalMap> map, std::string topic,
              std::string frame);

  void show(const LiveTopic& topic, std::int64_t stamp_ns, std::string_view bytes);

 private:
  void show_mounts(const LiveTopic& topic, std::int64_t stamp_ns, std::string_view bytes);

  FoxgloveServer& server_;
  std::shared_ptr<const GlobalMap> map_;
  std::string topic_, frame_;
  bool is_map_shown_ = false;
  std::map<std::string, bags::FrameTransform> mounts_;  ///< Of tf_static, by child frame.
};

}  // namespace glocal::app
