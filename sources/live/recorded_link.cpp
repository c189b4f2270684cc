#include "sources/live/recorded_link.hpp"

#include <algorithm>
#include <utility>

#include "glocal/error.hpp"
#include "sources/bags/message_definitions.hpp"

namespace glocal::live {
namespace {

std::ofstream opened(const std::filesystem::path& file) {
  if (std::filesystem::exists(file))
    throw ConfigError({{file.string(), 0, 0, "is there already; give another name, or remove it"}});
  std::ofstream stream(file, std::ios::binary);
  if (!stream)
    throw ConfigError({{file.string(), 0, 0, "cannot be written; check the folder and its permissions"}});
  return stream;
}

}  // namespace

RecordedLink::RecordedLink(std::shared_ptr<MessageLink> link, const std::filesystem::path& file)
    : link_(std::move(link)),
      name_(file.string()),
      file_(opened(file)),
      writer_([this](std::string_view bytes) {
        file_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
      }) {}

RecordedLink::~RecordedLink() {
  writer_.finish();
}

std::optional<LiveMessage> RecordedLink::next(std::chrono::milliseconds longest) {
  auto message = link_->next(longest);
  if (message) write(message->topic, message->stamp_ns, message->bytes);
  return message;
}

void RecordedLink::publish(const LiveTopic& topic, Delivery delivery, std::string_view bytes) {
  link_->publish(topic, delivery, bytes);
  write(topic, last_ns_, bytes);
}

/// In the order in which messages are taken, which need not be that of their receipt on several topics: their
/// stamps are made to agree, so that they are read in this order again.
void RecordedLink::write(const LiveTopic& topic, std::int64_t stamp_ns, std::string_view bytes) {
  last_ns_ = std::max(last_ns_, stamp_ns);
  auto channel = channels_.find(topic.name);
  if (channel == channels_.end()) {
    const std::uint16_t id = writer_.add_channel(topic.name, topic.type, bags::definition_of(topic.type));
    channel = channels_.emplace(topic.name, id).first;
  }
  writer_.write(channel->second, last_ns_, bytes);
  if (!file_) throw ConfigError({{name_, 0, 0, "cannot be written any further; is the disk full?"}});
}

}  // namespace glocal::live
