// What holds for every recording that is read, whatever its format.
#pragma once

#include "fuzz/harness.hpp"
#include "sources/bags/recording_summary.hpp"

namespace glocal::fuzz {

/// Reads a recording as `glocal bag info` does. `beginning`: of its format, so that no input is another one.
inline int try_recording(const std::uint8_t* data, std::size_t size, std::string_view beginning) {
  const std::string content = text_of(data, size);
  if (!content.starts_with(beginning)) return 0;
  const auto file = write("recording", content);
  return answer([&] {
    bags::Recording recording(file);
    std::vector<std::string> remarks;
    const bags::RecordingSummary summary = bags::summarize_recording(recording, remarks);
    std::size_t messages = 0;
    for (const bags::TopicSummary& topic : summary.topics) messages += topic.messages;
    must_hold(messages == summary.messages, "each message is of a topic");
    static_cast<void>(bags::frame_tree(summary.parents, 1000));
  });
}

}  // namespace glocal::fuzz
