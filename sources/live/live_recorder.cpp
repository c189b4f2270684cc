#include "sources/live/live_recorder.hpp"

#include "glocal/error.hpp"
#include "sources/bags/message_definitions.hpp"

namespace glocal::live {
namespace {

std::ofstream opened(const std::filesystem::path& file) {
  if (std::filesystem::exists(file))
    throw ConfigError(file, "is there already; give another name, or remove it");
  std::ofstream stream(file, std::ios::binary);
  if (!stream) throw ConfigError(file, "cannot be written; check the folder and its permissions");
  return stream;
}

}  // namespace

LiveRecorder::LiveRecorder(const std::filesystem::path& file)
    : name_(file.string()), file_(opened(file)), writer_([this](std::string_view bytes) {
        file_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
      }) {}

LiveRecorder::~LiveRecorder() {
  writer_.finish();
}

void LiveRecorder::write(const LiveTopic& topic, std::int64_t stamp_ns, std::string_view bytes) {
  auto channel = channels_.find(topic.name);
  if (channel == channels_.end()) {
    const std::uint16_t id = writer_.add_channel(topic.name, topic.type, bags::definition_of(topic.type));
    channel = channels_.emplace(topic.name, id).first;
  }
  writer_.write(channel->second, stamp_ns, bytes);
  if (!file_) throw ConfigError(name_, "cannot be written any further; is the disk full?");
}

}  // namespace glocal::live
