#include "app/foxglove_client.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/endian/conversion.hpp>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "sources/bags/message_definitions.hpp"

namespace glocal::app {
namespace {

using nlohmann::json;

/// Names come from robots, and need not be UTF-8.
std::string text_of(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

/// None where it is no id.
std::optional<std::uint32_t> id_of(const json& value) {
  if (!value.is_number_unsigned()) return std::nullopt;
  const auto id = value.get<std::uint64_t>();
  if (id > std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
  return static_cast<std::uint32_t>(id);
}

std::optional<std::uint32_t> id_in(const json& object, const char* key) {
  return object.is_object() ? id_of(object.value(key, json())) : std::nullopt;
}

json list_in(const json& request, const char* key) {
  json list = request.value(key, json());
  return list.is_array() ? list : json::array();
}

std::string head_of_message(std::uint32_t subscription, std::int64_t stamp_ns) {
  constexpr unsigned char message_data = 1;
  std::array<unsigned char, 13> head{message_data};
  boost::endian::store_little_u32(&head[1], subscription);
  boost::endian::store_little_u64(&head[5], static_cast<std::uint64_t>(stamp_ns));
  return {head.begin(), head.end()};
}

}  // namespace

std::size_t FoxgloveFrame::size() const {
  return sizeof(FoxgloveFrame) + head.size() + (message ? message->bytes.size() : 0);
}

FoxgloveClient::FoxgloveClient(const std::vector<FoxgloveChannel>& channels, std::size_t most_bytes)
    : channels_(channels), most_bytes_(most_bytes) {
  const json info = {{"op", "serverInfo"}, {"name", "glocal live"}, {"capabilities", json::array()}};
  push({.head = text_of(info), .message = nullptr, .may_be_lost = false});
  advertise(0);
}

void FoxgloveClient::advertise(std::size_t first) {
  json added = json::array();
  for (std::size_t id = first; id < channels_.size(); ++id) {
    const LiveTopic& topic = channels_[id].topic;
    added.push_back({{"id", id},
                     {"topic", topic.name},
                     {"encoding", "cdr"},
                     {"schemaName", bags::ros2_type(topic.type)},
                     {"schemaEncoding", "ros2msg"},
                     {"schema", bags::definition_of(topic.type)}});
  }
  const json advertised = {{"op", "advertise"}, {"channels", added}};
  push({.head = text_of(advertised), .message = nullptr, .may_be_lost = false});
}

void FoxgloveClient::take(std::string_view text) {
  const json request = json::parse(text, nullptr, false);
  if (!request.is_object()) return refuse("what was sent is no JSON object");
  const json op = request.value("op", json());
  if (op == "subscribe") {
    for (const json& wanted : list_in(request, "subscriptions"))
      subscribe(id_in(wanted, "channelId"), id_in(wanted, "id"));
  } else if (op == "unsubscribe") {
    for (const json& id : list_in(request, "subscriptionIds")) unsubscribe(id_of(id));
  } else {
    refuse(fmt::format("{} is not offered: viewers can subscribe and unsubscribe", text_of(op)));
  }
}

void FoxgloveClient::take_binary() {
  refuse("viewers can publish nothing and call no services");
}

void FoxgloveClient::subscribe(std::optional<std::uint32_t> channel,
                               std::optional<std::uint32_t> subscription) {
  if (!channel || *channel >= channels_.size()) return refuse("there is no such channel to subscribe to");
  const bool is_taken = std::any_of(subscriptions_.begin(), subscriptions_.end(), [&](const auto& other) {
    return other.first == channel || other.second == subscription;
  });
  if (!subscription || is_taken)
    return refuse(fmt::format("a subscription to {} needs an id of its own, and there can be one only",
                              channels_[*channel].topic.name));
  subscriptions_.emplace(*channel, *subscription);
  if (channels_[*channel].kept) offer(*channel, channels_[*channel].kept);
}

void FoxgloveClient::unsubscribe(std::optional<std::uint32_t> subscription) {
  const auto found = std::find_if(subscriptions_.begin(), subscriptions_.end(),
                                  [&](const auto& other) { return other.second == subscription; });
  if (found == subscriptions_.end()) return refuse("there is no such subscription to end");
  forget(found->first);
  subscriptions_.erase(found);
}

void FoxgloveClient::offer(std::uint32_t channel, std::shared_ptr<const FoxgloveMessage> message) {
  const auto subscription = subscriptions_.find(channel);
  if (subscription == subscriptions_.end()) return;
  const bool is_kept = message == channels_[channel].kept;
  if (is_kept) forget(channel);
  push({head_of_message(subscription->second, message->stamp_ns), std::move(message), channel, !is_kept});
}

void FoxgloveClient::refuse(const std::string& why) {
  constexpr int error = 2;
  const json status = {{"op", "status"}, {"level", error}, {"message", why}};
  push({.head = text_of(status), .message = nullptr});
}

void FoxgloveClient::push(FoxgloveFrame frame) {
  bytes_ += frame.size();
  waiting_.push_back(std::move(frame));
  const auto may_be_lost = [](const FoxgloveFrame& waiting) { return waiting.may_be_lost; };
  while (bytes_ > most_bytes_) {
    const auto oldest = std::find_if(waiting_.begin(), std::prev(waiting_.end()), may_be_lost);
    if (oldest == std::prev(waiting_.end())) return;
    bytes_ -= oldest->size();
    waiting_.erase(oldest);
  }
}

void FoxgloveClient::forget(std::uint32_t channel) {
  std::erase_if(waiting_, [&](const FoxgloveFrame& frame) {
    const bool is_of_channel = frame.message && frame.channel == channel;
    if (is_of_channel) bytes_ -= frame.size();
    return is_of_channel;
  });
}

std::optional<FoxgloveFrame> FoxgloveClient::next() {
  if (waiting_.empty()) return std::nullopt;
  FoxgloveFrame frame = std::move(waiting_.front());
  waiting_.pop_front();
  bytes_ -= frame.size();
  return frame;
}

}  // namespace glocal::app
