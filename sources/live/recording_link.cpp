#include "sources/live/recording_link.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <thread>
#include <utility>

#include "glocal/error.hpp"
#include "glocal/words.hpp"
#include "sources/bags/cdr_writer.hpp"
#include "sources/bags/message_definitions.hpp"
#include "sources/bags/message_reader.hpp"

namespace glocal::live {
namespace {

void require_known(const LiveTopic& topic) {
  if (!bags::definition_of(topic.type).empty()) return;
  throw ConfigError(topic.name,
                    fmt::format("messages of {} are not known; types are written as sensor_msgs/LaserScan",
                                shown(topic.type)));
}

LiveTopic topic_of(const bags::Connection& connection) {
  return {connection.topic, bags::type_in_ros2(connection.type)};
}

}  // namespace

void describe(ParamVisitor& v, RecordingLink::Params& p) {
  v.field("path", p.path,
          {.doc = "ROS 1 bag, ROS 2 bag (.db3 or its folder) or MCAP file.",
           .required = true,
           .may_be_folder = true});
  v.field("in_real_time", p.in_real_time,
          {.doc = "Messages come when they came to the recorder, and who is slow misses some. Otherwise they "
                  "wait."});
}

RecordingLink::RecordingLink(const Params& params, const SourceSetup& setup)
    : is_live_(params.in_real_time), warn_(setup.warn), recording_(params.path.resolved) {
  for (const auto& input : recording_.inputs()) setup.note_input(input);
  recording_.rewind();
}

void RecordingLink::subscribe(const LiveTopic& topic, Delivery /*delivery*/) {
  require_known(topic);
  asked_for_.insert(topic.name);
}

void RecordingLink::publish(const LiveTopic& topic, Delivery /*delivery*/, std::string_view /*bytes*/) {
  require_known(topic);
}

std::optional<std::string> RecordingLink::cdr_of(const bags::RecordedMessage& message) {
  const bags::Connection& connection = *message.connection;
  if (connection.encoding == "cdr") return std::string(message.bytes);
  if (bags::definition_of(bags::type_in_ros2(connection.type)).empty()) return std::nullopt;
  try {
    return bags::as_cdr(message);
  } catch (const ConfigError& error) {
    if (!std::exchange(has_warned_, true))
      warn_(fmt::format("a message of {} is left out: {}; others like it are not told",
                        shown(connection.topic), error.what()));
    return std::nullopt;
  }
}

std::optional<LiveMessage> RecordingLink::next(std::chrono::milliseconds longest) {
  while (!waiting_ && !has_ended_) {
    const auto message = recording_.next();
    has_ended_ = !message;
    if (!message || !asked_for_.contains(message->connection->topic) ||
        !bags::is_readable(*message->connection))
      continue;
    if (auto bytes = cdr_of(*message))
      waiting_ = {topic_of(*message->connection), message->stamp_ns, *std::move(bytes)};
  }
  if (!waiting_) return std::nullopt;
  if (is_live_) {
    if (!begun_) {
      begun_ = Clock::now();
      first_ns_ = waiting_->stamp_ns;
    }
    const auto its_time = *begun_ + std::chrono::nanoseconds(waiting_->stamp_ns - first_ns_);
    const auto until = std::min(its_time, Clock::now() + longest);
    std::this_thread::sleep_until(until);
    if (until < its_time) return std::nullopt;
  }
  return std::exchange(waiting_, std::nullopt);
}

std::vector<LiveTopic> RecordingLink::topics() {
  std::vector<LiveTopic> topics;
  for (const bags::Connection& connection : recording_.connections()) {
    if (bags::is_readable(connection)) topics.push_back(topic_of(connection));
  }
  std::ranges::sort(topics, {}, &LiveTopic::name);
  topics.erase(std::unique(topics.begin(), topics.end()), topics.end());
  return topics;
}

}  // namespace glocal::live
