#include "app/live_viewers.hpp"

#include <utility>
#include <vector>

#include "glocal/error.hpp"
#include "sources/bags/cdr_writer.hpp"
#include "sources/live/live_map.hpp"

namespace glocal::app {

LiveViewers::LiveViewers(FoxgloveServer& server, std::shared_ptr<const GlobalMap> map, std::string topic,
                         std::string frame)
    : server_(server), map_(std::move(map)), topic_(std::move(topic)), frame_(std::move(frame)) {
  for (const MapPart& part : map_->parts())
    mounts_.insert({part.name, {{0, frame_}, part.name, part.common_from_part}});
}

void LiveViewers::show(const LiveTopic& topic, std::int64_t stamp_ns, std::string_view bytes) {
  // Not earlier: who sees the robot's clock only takes a map of another time for one that is to come, or old.
  if (!std::exchange(is_map_shown_, true)) {
    const LiveMessage map = live::map_message(map_->data(), topic_, {stamp_ns, frame_});
    server_.offer(map.topic, map.stamp_ns, map.bytes, true);
  }
  if (topic.name.ends_with("/tf_static")) return show_mounts(topic, stamp_ns, bytes);
  server_.offer(topic, stamp_ns, bytes);
}

/// Each sender tells those that it knows, once: who comes late needs all of them.
void LiveViewers::show_mounts(const LiveTopic& topic, std::int64_t stamp_ns, std::string_view bytes) {
  const bags::Connection connection{topic.name, topic.type, "cdr", ""};
  try {
    for (bags::FrameTransform& mount :
         bags::read_transforms({&connection, stamp_ns, bytes, {.file = topic.name}}))
      mounts_.insert_or_assign(mount.child_frame, std::move(mount));
  } catch (const ConfigError&) {
    return;  // The drive tells of it.
  }
  std::vector<bags::FrameTransform> all;
  for (const auto& [child, mount] : mounts_) all.push_back(mount);
  server_.offer(topic, stamp_ns, bags::serialized(all), true);
}

}  // namespace glocal::app
