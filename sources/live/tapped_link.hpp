// A link whose messages somebody else gets, too.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "glocal/message_link.hpp"

namespace glocal::live {

/// What comes over another link, and what is published on it, goes to a tap, too.
class TappedLink final : public MessageLink {
 public:
  /// Gets messages in the order in which they are taken, which need not be that of their receipt on several
  /// topics: their stamps are made to agree, and never fall.
  using Tap = std::function<void(const LiveTopic&, std::int64_t stamp_ns, std::string_view bytes)>;

  /// What is published on the topics of these names goes to the tap alone.
  TappedLink(std::shared_ptr<MessageLink> link, Tap tap, std::set<std::string> kept_back = {});

  void subscribe(const LiveTopic& topic, Delivery delivery) override { link_->subscribe(topic, delivery); }
  [[nodiscard]] std::optional<LiveMessage> next(std::chrono::milliseconds longest) override;
  [[nodiscard]] bool is_live() const override { return link_->is_live(); }
  [[nodiscard]] bool has_ended() const override { return link_->has_ended(); }
  void advertise(const LiveTopic& topic, Delivery delivery) override;
  void publish(const LiveTopic& topic, Delivery delivery, std::string_view bytes) override;
  [[nodiscard]] std::vector<LiveTopic> topics() override { return link_->topics(); }

 private:
  std::shared_ptr<MessageLink> link_;
  Tap tap_;
  std::set<std::string> kept_back_;
  std::int64_t last_ns_ = 0;
};

}  // namespace glocal::live
