// Messages that are exchanged with a robot while it drives.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glocal {

/// What messages are about, and their type, as `sensor_msgs/LaserScan`.
struct LiveTopic {
  std::string name;  ///< With its slash: `/scan`.
  std::string type;

  friend bool operator==(const LiveTopic&, const LiveTopic&) = default;
};

/// How messages of a topic are delivered, as robots with ROS 2 are used to it.
enum class Delivery {
  newest,    ///< What is lost is lost: scans, clouds.
  reliable,  ///< All, in order: tf, odometry.
  kept,      ///< All, and the last one of each sender for who comes late: maps, tf_static.
};

/// A message as it came.
struct LiveMessage {
  LiveTopic topic;
  std::int64_t stamp_ns = 0;  ///< When it was received, ns since 1970.
  std::string bytes;          ///< CDR with its encapsulation header (OMG DDS-RTPS 2.2, chapter 10).
};

/// A way to a robot's messages and back, by name: strategies of the kind `message_link`.
/// Contract: calls come from one thread; messages of one topic and sender come in their order; nothing waits
/// for longer than it is told to.
class MessageLink {
 public:
  virtual ~MessageLink() = default;
  /// Messages of this topic are wanted from now on. Throws ConfigError for a type that the link does not
  /// know.
  virtual void subscribe(const LiveTopic& topic, Delivery delivery) = 0;
  /// The next message of a topic that was subscribed to; none if none came within this time.
  [[nodiscard]] virtual std::optional<LiveMessage> next(std::chrono::milliseconds longest) = 0;
  /// A robot's messages come when they come; those of a recording wait until they are asked for.
  [[nodiscard]] virtual bool is_live() const { return true; }
  /// Whether nothing will come any more; a robot is never at its end.
  [[nodiscard]] virtual bool has_ended() const { return false; }
  /// Messages of this topic will be sent: who is to receive them can find it before the first one, which may
  /// be missed otherwise. Throws ConfigError for a type that the link does not know.
  virtual void advertise(const LiveTopic& /*topic*/, Delivery /*delivery*/) {}
  /// Sends a message. Throws ConfigError for a type that the link does not know.
  virtual void publish(const LiveTopic& topic, Delivery delivery, std::string_view bytes) = 0;
  /// What others send, as far as the link has heard of it, in the order of the names.
  [[nodiscard]] virtual std::vector<LiveTopic> topics() = 0;
};

}  // namespace glocal
