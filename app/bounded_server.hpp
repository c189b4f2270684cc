// An HTTP server that no client can hold up or fill up: httplib's, with limits on each connection.
#pragma once

#include <httplib.h>
// A macro of <resolv.h>, which httplib brings, and a name of Eigen's.
#undef _res

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <vector>

#include "app/connection_limits.hpp"

namespace glocal::app {

/// The connections that are open. A new one takes the place of the one that has been silent for longest.
class Connections {
 public:
  explicit Connections(std::size_t most) : most_(most) {}

  /// False if there is no room: all others are being answered, or the server ends.
  [[nodiscard]] bool enter(socket_t socket);
  /// Has sent its whole request.
  void has_asked(socket_t socket);
  /// To be called before the socket is closed: its number may then be another connection's.
  void leave(socket_t socket);
  /// Ends all of them, those that are being answered after this long; none enters from now on.
  void end(std::chrono::milliseconds grace);

 private:
  struct Connection {
    socket_t socket;
    bool has_asked = false;
  };

  std::size_t most_;
  std::mutex mutex_;
  std::condition_variable left_;
  std::vector<Connection> open_;  ///< Oldest first.
  bool ended_ = false;
};

/// One request a connection, no bodies, no ranges, no waiting for slow clients.
class BoundedServer final : public httplib::Server {
 public:
  explicit BoundedServer(const ConnectionLimits& limits = {});

  /// To be called once it is bound: the library lets no more than five connections wait.
  void lengthen_queue();
  /// Stops listening, and ends what is connected.
  void end();
  /// Reads one request and answers it.
  void answer(httplib::Stream& stream);

 private:
  bool process_and_close_socket(socket_t socket) override;

  ConnectionLimits limits_;
  Connections connections_;
};

}  // namespace glocal::app
