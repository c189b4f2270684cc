#include "sources/conversion/copied_recording.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "glocal/error.hpp"
#include "glocal/words.hpp"
#include "sources/bags/cdr_writer.hpp"
#include "sources/bags/message_definitions.hpp"

namespace glocal::conversion {
namespace {

class RecordingCopier {
 public:
  RecordingCopier(bags::Recording& recording, bags::McapWriter::Sink sink)
      : recording_(recording), writer_(std::move(sink)) {}

  CopiedRecording copy() {
    recording_.rewind();
    while (const auto message = recording_.next()) take(*message);
    if (copied_.messages == 0)
      throw ConfigError(*recording_.inputs().begin(),
                        "has no message that can be written as MCAP; glocal bag info shows what it has");
    writer_.finish();
    for (const auto& [topic, lost] : lost_)
      copied_.remarks.push_back(
          fmt::format("{} messages of {} are left out: {}", lost.first, shown(topic), lost.second));
    copied_.remarks = first_of(std::move(copied_.remarks));
    return std::move(copied_);
  }

 private:
  void take(const bags::RecordedMessage& message) {
    const bags::Connection& connection = *message.connection;
    const auto [channel, is_new] = channels_.try_emplace(&connection);
    if (is_new) channel->second = channel_of(connection);
    if (!channel->second) return lose(connection.topic, why_left_out(connection));
    try {
      if (connection.encoding == "cdr") {
        writer_.write(*channel->second, message.stamp_ns, message.bytes);
      } else {
        writer_.write(*channel->second, message.stamp_ns, bags::as_cdr(message));
      }
      ++copied_.messages;
    } catch (const ConfigError& error) {
      lose(connection.topic, error.what());
    }
  }

  /// None if its messages cannot be written.
  std::optional<std::uint16_t> channel_of(const bags::Connection& connection) {
    const std::string type = bags::type_in_ros2(connection.type);
    const bool is_cdr = connection.encoding == "cdr";
    if (!is_cdr && connection.encoding != "ros1") return std::nullopt;
    const std::string definition =
        is_cdr && !connection.definition.empty() ? connection.definition : bags::definition_of(type);
    if (definition.empty()) return std::nullopt;
    // Each node that sends to a topic has its own connection in ROS 1.
    const auto [known, is_new] = by_name_.try_emplace({connection.topic, type, definition});
    if (is_new) known->second = writer_.add_channel(connection.topic, type, definition);
    return known->second;
  }

  [[nodiscard]] static std::string why_left_out(const bags::Connection& connection) {
    if (!connection.encoding.empty() && connection.encoding != "cdr" && connection.encoding != "ros1")
      return fmt::format("they are encoded as '{}', and only messages of ROS are written",
                         shown(connection.encoding));
    return fmt::format("the definition of {} for ROS 2 is not known", shown(connection.type));
  }

  void lose(const std::string& topic, const std::string& why) {
    ++lost_.try_emplace(topic, 0, why).first->second.first;
  }

  using Name = std::tuple<std::string, std::string, std::string>;  ///< Topic, type, definition.

  bags::Recording& recording_;
  bags::McapWriter writer_;
  std::map<const bags::Connection*, std::optional<std::uint16_t>> channels_;
  std::map<Name, std::uint16_t> by_name_;
  std::map<std::string, std::pair<std::size_t, std::string>> lost_;  ///< By topic: messages, and why.
  CopiedRecording copied_;
};

}  // namespace

CopiedRecording copy_recording(bags::Recording& recording, bags::McapWriter::Sink sink) {
  return RecordingCopier(recording, std::move(sink)).copy();
}

}  // namespace glocal::conversion
