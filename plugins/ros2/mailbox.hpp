// What Cyclone's threads have received, until the caller asks for it.
#pragma once

#include <dds/ddsi/ddsi_serdata.h>

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "glocal/message_link.hpp"

namespace glocal::ros2_plugin {

struct Unref {
  void operator()(ddsi_serdata* message) const { ddsi_serdata_unref(message); }
};
using Received = std::unique_ptr<ddsi_serdata, Unref>;

/// Messages of all topics in their order. Safe to use from several threads.
class Mailbox {
 public:
  /// Of a topic: where more wait than these, the oldest make way.
  struct Limits {
    std::size_t messages, bytes;
  };
  /// Messages of a topic that wait.
  struct Box;
  struct News {
    std::vector<std::string> notes;
    bool senders = false;  ///< Others may send other topics than before.
    std::optional<LiveMessage> message;
  };

  /// Makes a box that stays where it is.
  Box& add(const LiveTopic& topic, const Limits& limits);
  void put(Box& box, Received message);
  /// Something has happened that the user should read of.
  void note(std::string sentence);
  void note_senders();
  /// What has happened since, and the message that waits longest; waits until there is something.
  [[nodiscard]] News take(std::chrono::steady_clock::time_point until);
  /// What has happened since, and no message.
  [[nodiscard]] News take_notes();

 private:
  struct Waiting {
    std::uint64_t number;  ///< Of all messages received.
    std::int64_t stamp_ns;
    Received message;
  };
  Box* oldest();
  static Waiting first_of(Box& box);

  std::mutex mutex_;
  std::condition_variable changed_;
  std::uint64_t received_ = 0;
  News news_;  ///< Without a message.
  std::list<Box> boxes_;
};

/// Its mailbox alone looks at what waits.
struct Mailbox::Box {
  Mailbox& mailbox;
  LiveTopic topic;
  Limits limits;
  std::deque<Waiting> waiting = {};
  std::size_t bytes = 0;  ///< Of all that wait.
};

}  // namespace glocal::ros2_plugin
