// Robots' own recordings, as MCAP.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "sources/bags/mcap_writer.hpp"
#include "sources/bags/recording.hpp"

namespace glocal::conversion {

struct CopiedRecording {
  std::size_t messages = 0;
  std::vector<std::string> remarks;  ///< What was left out, a sentence for each topic.
};

/// Copies a recording message by message: those of ROS 2 as they are, those of ROS 1 whose types
/// bags::definition_of() knows in ROS 2's serialization. Throws ConfigError if nothing can be copied.
[[nodiscard]] CopiedRecording copy_recording(bags::Recording& recording, bags::McapWriter::Sink sink);

}  // namespace glocal::conversion
