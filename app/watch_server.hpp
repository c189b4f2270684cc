// A page on this machine that shows a run while it goes on.
#pragma once

#include <memory>

#include "report/live_run.hpp"

namespace glocal::app {

/// Serves the page and its data to browsers on this machine, from threads of its own, as long as it lives.
class WatchServer {
 public:
  /// On this port of 127.0.0.1, or with 0 on a free one. Throws ConfigError if the port is taken.
  WatchServer(int port, LiveRun& run);
  ~WatchServer();
  WatchServer(const WatchServer&) = delete;
  WatchServer& operator=(const WatchServer&) = delete;

  [[nodiscard]] int port() const;

 private:
  class Server;  ///< Its library's header is large.
  std::unique_ptr<Server> server_;
};

}  // namespace glocal::app
