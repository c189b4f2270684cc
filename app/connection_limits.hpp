// What clients of a server may take of it.
#pragma once

#include <chrono>
#include <cstddef>

namespace glocal::app {

struct ConnectionLimits {
  std::size_t connections = 64;               ///< At once.
  std::size_t request_bytes = 16'384;         ///< Request line and headers; a message of a WebSocket.
  std::chrono::milliseconds to_ask{2000};     ///< From the connection to the last byte of its request.
  std::chrono::milliseconds to_take{30'000};  ///< For the client to take its answer.
  std::chrono::milliseconds grace{300};       ///< For answers under way when the server ends.
};

}  // namespace glocal::app
