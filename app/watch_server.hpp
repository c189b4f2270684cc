// A page on this machine that shows a run while it goes on.
#pragma once

#include <memory>
#include <thread>

#include "report/live_run.hpp"

namespace glocal::app {

class BoundedServer;

/// Serves the page and its data to browsers on this machine, from threads of its own, as long as it lives.
class WatchServer {
 public:
  /// On this port of 127.0.0.1, or with 0 on a free one. Throws ConfigError if the port is taken.
  WatchServer(int port, LiveRun& run);
  ~WatchServer();
  WatchServer(const WatchServer&) = delete;
  WatchServer& operator=(const WatchServer&) = delete;

  [[nodiscard]] int port() const { return port_; }

 private:
  void bind(int port);

  std::unique_ptr<BoundedServer> server_;  ///< Its library's header is large.
  int port_ = -1;
  std::thread thread_;
};

}  // namespace glocal::app
