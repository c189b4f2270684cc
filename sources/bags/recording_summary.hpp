// What is in a recording.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "sources/bags/messages.hpp"
#include "sources/bags/recording.hpp"

namespace glocal::bags {

/// What all messages of a topic and type have in common.
struct TopicSummary {
  std::string topic, type, encoding;
  std::size_t messages = 0;
  std::int64_t first_ns = 0, last_ns = 0;  ///< Stamps of receipt.
  std::set<std::string> frames;            ///< Of headers, or parents of transforms.
  std::optional<LaserScan> first_scan;
  std::size_t unreadable = 0;  ///< Messages that break their definition.

  /// Messages a second; 0 if there are less than two stamps.
  [[nodiscard]] double rate_hz() const;
};

struct RecordingSummary {
  std::vector<TopicSummary> topics;  ///< By name.
  std::size_t messages = 0;
  std::int64_t first_ns = 0, last_ns = 0;      ///< Of all messages.
  std::map<std::string, std::string> parents;  ///< Parent of each frame, by tf; the last one that was said.
  std::string odometry;                        ///< Topic, or "odom -> base_link"; empty if there is none.
  double path_m = 0.0;                         ///< Driven, as that odometry has it.
};

/// Reads the whole recording. Of each topic, and of tf, 10,000 frames are noted. What cannot be read of
/// single messages is counted, and the first of a topic is told in `remarks`.
[[nodiscard]] RecordingSummary summarize_recording(Recording& recording, std::vector<std::string>& remarks);

/// "1440 beams over 359.7 deg, range 0.50 to 250.00 m"
[[nodiscard]] std::string text_of(const LaserScan& scan);
/// "/scan: 10.0 Hz, 1440 beams over 359.7 deg, range 0.50 to 250.00 m, frame laser"
[[nodiscard]] std::string text_of(const TopicSummary& topic);

/// The tree of frames, a line each, indented below its parent; 50 levels of it, and so many lines.
[[nodiscard]] std::string frame_tree(const std::map<std::string, std::string>& parents,
                                     std::size_t most_lines);

}  // namespace glocal::bags
