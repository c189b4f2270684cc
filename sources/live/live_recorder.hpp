// The messages of a link, written down as they come.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <string_view>

#include "glocal/catalog.hpp"
#include "glocal/message_link.hpp"
#include "sources/bags/mcap_writer.hpp"

namespace glocal::live {

/// Writes messages to an MCAP file: replayed, it gives the same drive. A robot needs its place though the
/// disk is full: where the file cannot be written any further, that is told once, and no more is written.
class LiveRecorder {
 public:
  /// Throws ConfigError if the file is there already, or cannot be written.
  LiveRecorder(const std::filesystem::path& file, Warn warn);
  /// Ends the file.
  ~LiveRecorder();
  LiveRecorder(const LiveRecorder&) = delete;
  LiveRecorder& operator=(const LiveRecorder&) = delete;

  void write(const LiveTopic& topic, std::int64_t stamp_ns, std::string_view bytes);

 private:
  /// Does something with the file, if it could be written so far.
  void attempt(const std::function<void()>& work);

  std::string name_;
  Warn warn_;
  bool is_whole_ = true;
  std::ofstream file_;
  bags::McapWriter writer_;
};

}  // namespace glocal::live
