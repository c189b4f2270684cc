// The messages of a link, written down as they come.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <string_view>

#include "glocal/message_link.hpp"
#include "sources/bags/mcap_writer.hpp"

namespace glocal::live {

/// Writes messages to an MCAP file: replayed, it gives the same drive.
class LiveRecorder {
 public:
  /// Throws ConfigError if the file is there already, or cannot be written.
  explicit LiveRecorder(const std::filesystem::path& file);
  /// Ends the file; what could not be written is lost then.
  ~LiveRecorder();
  LiveRecorder(const LiveRecorder&) = delete;
  LiveRecorder& operator=(const LiveRecorder&) = delete;

  /// Throws ConfigError if the file cannot be written any further.
  void write(const LiveTopic& topic, std::int64_t stamp_ns, std::string_view bytes);

 private:
  std::string name_;
  std::ofstream file_;
  bags::McapWriter writer_;
  std::map<std::string, std::uint16_t> channels_;  ///< By topic.
};

}  // namespace glocal::live
