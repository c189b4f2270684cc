// One viewer's side of Foxglove's WebSocket protocol (github.com/foxglove/ws-protocol, docs/spec.md), without
// its connection.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "glocal/message_link.hpp"

namespace glocal::app {

/// A message that viewers share.
struct FoxgloveMessage {
  std::int64_t stamp_ns = 0;
  std::string bytes;  ///< CDR
};

/// What viewers can subscribe to; its id is its place among all.
struct FoxgloveChannel {
  LiveTopic topic;
  std::shared_ptr<const FoxgloveMessage> kept;  ///< For who comes late; perhaps none.
};

/// What goes out as one message of the WebSocket.
struct FoxgloveFrame {
  std::string head;                                ///< All of a text.
  std::shared_ptr<const FoxgloveMessage> message;  ///< After the head of binary ones; none of a text.
  std::uint32_t channel = 0;                       ///< Of the message.
  bool may_be_lost = true;

  [[nodiscard]] bool is_text() const { return message == nullptr; }
  [[nodiscard]] std::size_t size() const;
};

/// What a viewer wants, and what is to be sent to it: where it takes that too slowly, the oldest is lost.
class FoxgloveClient {
 public:
  /// `channels` must outlive this, and are only added to. No more than about `most_bytes` wait, but for maps
  /// and other messages that are kept: one of each channel.
  FoxgloveClient(const std::vector<FoxgloveChannel>& channels, std::size_t most_bytes);

  /// A text that the viewer has sent. What is no request, or cannot be met, is told to it.
  void take(std::string_view text);
  /// It has sent something else.
  void take_binary();
  /// All channels from this one on are new.
  void advertise(std::size_t first);
  /// Is sent if the viewer has subscribed to it.
  void offer(std::uint32_t channel, std::shared_ptr<const FoxgloveMessage> message);

  /// What is to be sent next.
  [[nodiscard]] std::optional<FoxgloveFrame> next();

 private:
  void subscribe(std::optional<std::uint32_t> channel, std::optional<std::uint32_t> subscription);
  void unsubscribe(std::optional<std::uint32_t> subscription);
  void refuse(const std::string& why);
  void push(FoxgloveFrame frame);
  /// What waits of a channel is not sent.
  void forget(std::uint32_t channel);

  const std::vector<FoxgloveChannel>& channels_;
  std::size_t most_bytes_, bytes_ = 0;
  std::map<std::uint32_t, std::uint32_t> subscriptions_;  ///< By channel.
  std::deque<FoxgloveFrame> waiting_;
};

}  // namespace glocal::app
