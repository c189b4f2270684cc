#include "sources/live/tapped_link.hpp"

#include <algorithm>
#include <utility>

namespace glocal::live {

TappedLink::TappedLink(std::shared_ptr<MessageLink> link, Tap tap, std::set<std::string> kept_back)
    : link_(std::move(link)), tap_(std::move(tap)), kept_back_(std::move(kept_back)) {}

std::optional<LiveMessage> TappedLink::next(std::chrono::milliseconds longest) {
  auto message = link_->next(longest);
  if (message) {
    last_ns_ = std::max(last_ns_, message->stamp_ns);
    tap_(message->topic, last_ns_, message->bytes);
  }
  return message;
}

void TappedLink::advertise(const LiveTopic& topic, Delivery delivery) {
  if (!kept_back_.contains(topic.name)) link_->advertise(topic, delivery);
}

void TappedLink::publish(const LiveTopic& topic, Delivery delivery, std::string_view bytes) {
  if (!kept_back_.contains(topic.name)) link_->publish(topic, delivery, bytes);
  tap_(topic, last_ns_, bytes);
}

}  // namespace glocal::live
