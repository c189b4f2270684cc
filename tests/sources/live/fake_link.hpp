// A robot that says what a test wants it to say.
#pragma once

#include <algorithm>
#include <deque>
#include <set>
#include <string>
#include <vector>

#include "glocal/message_link.hpp"

namespace glocal::test::live {

/// Gives the messages that were put in of topics that are asked for; keeps what is published.
class FakeLink final : public MessageLink {
 public:
  void put(const LiveTopic& topic, std::int64_t stamp_ns, const std::string& bytes) {
    messages_.push_back({topic, stamp_ns, bytes});
    if (std::find(there_.begin(), there_.end(), topic) == there_.end()) there_.push_back(topic);
  }
  void announce(const LiveTopic& topic) { there_.push_back(topic); }
  void end() { ends_ = true; }

  void subscribe(const LiveTopic& topic, Delivery /*delivery*/) override { wanted_.insert(topic.name); }
  std::optional<LiveMessage> next(std::chrono::milliseconds /*longest*/) override {
    const auto found = std::find_if(messages_.begin(), messages_.end(),
                                    [&](const LiveMessage& m) { return wanted_.contains(m.topic.name); });
    if (found == messages_.end()) return std::nullopt;
    LiveMessage message = *found;
    messages_.erase(found);
    return message;
  }
  bool has_ended() const override { return ends_; }
  void advertise(const LiveTopic& topic, Delivery /*delivery*/) override { advertised.push_back(topic.name); }
  void publish(const LiveTopic& topic, Delivery delivery, std::string_view bytes) override {
    published.push_back({topic, 0, std::string(bytes)});
    deliveries.push_back(delivery);
  }
  std::vector<LiveTopic> topics() override { return there_; }

  std::vector<std::string> advertised;
  std::vector<LiveMessage> published;
  std::vector<Delivery> deliveries;

 private:
  std::deque<LiveMessage> messages_;
  std::vector<LiveTopic> there_;
  std::set<std::string> wanted_;
  bool ends_ = false;
};

}  // namespace glocal::test::live
