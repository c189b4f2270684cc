// A live localization for viewers that speak Foxglove's WebSocket protocol.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "app/connection_limits.hpp"
#include "glocal/message_link.hpp"

namespace glocal::app {

struct FoxgloveLimits {
  ConnectionLimits connection = {};
  std::size_t queue_bytes = std::size_t{1} << 24U;  ///< That wait for a viewer, and for the server's thread.
};

/// Sends messages to whoever subscribes to their topics, from a thread of its own, as long as it lives.
/// Viewers change nothing, and who takes messages too slowly misses some.
class FoxgloveServer {
 public:
  /// On this address and port, or with 0 on a free one. Throws ConfigError if the port is taken, or the
  /// address is none of this machine.
  FoxgloveServer(const std::string& address, int port, const FoxgloveLimits& limits = {});
  /// Sends what waits, no longer than the limits say.
  ~FoxgloveServer();
  FoxgloveServer(const FoxgloveServer&) = delete;
  FoxgloveServer& operator=(const FoxgloveServer&) = delete;

  /// "127.0.0.1:8765"
  [[nodiscard]] std::string endpoint() const;
  /// Waits for nobody. The last message that is `kept` goes to those who subscribe later, too. To be called
  /// from one thread.
  void offer(const LiveTopic& topic, std::int64_t stamp_ns, std::string_view bytes, bool is_kept = false);

 private:
  class Server;  ///< Its library's headers are large.
  std::unique_ptr<Server> server_;
};

}  // namespace glocal::app
