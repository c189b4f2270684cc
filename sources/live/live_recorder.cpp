#include "sources/live/live_recorder.hpp"

#include <fmt/format.h>

#include <exception>
#include <utility>

#include "glocal/error.hpp"

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

LiveRecorder::LiveRecorder(const std::filesystem::path& file, Warn warn)
    : name_(file.string()),
      warn_(std::move(warn)),
      file_(opened(file)),
      writer_([this](std::string_view bytes) {
        file_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
      }) {}

LiveRecorder::~LiveRecorder() {
  attempt([this] {
    writer_.finish();
    file_.close();
  });
}

void LiveRecorder::write(const LiveTopic& topic, std::int64_t stamp_ns, std::string_view bytes) {
  attempt([&] { writer_.write(topic.name, topic.type, stamp_ns, bytes); });
}

void LiveRecorder::attempt(const std::function<void()>& work) {
  if (!is_whole_) return;
  try {
    work();
    is_whole_ = !file_.fail();
  } catch (const std::exception&) {  // Of the compressor, or where memory is short.
    is_whole_ = false;
  }
  if (!is_whole_)
    warn_(fmt::format("{}: cannot be written any further; the recording is not whole. Is the disk full?",
                      name_));
}

}  // namespace glocal::live
