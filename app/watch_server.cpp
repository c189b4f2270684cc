#include "app/watch_server.hpp"

#include <fmt/format.h>
#include <sys/socket.h>

#include <chrono>

#include "app/bounded_server.hpp"
#include "app/watch_requests.hpp"
#include "glocal/error.hpp"

namespace glocal::app {
namespace {

/// The library's own options let a second program listen on the same port.
void only_listener(socket_t socket) {
  const int yes = 1;
  setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
}

}  // namespace

WatchServer::WatchServer(int port, LiveRun& run) : server_(std::make_unique<BoundedServer>()) {
  server_->set_socket_options(only_listener);
  bind(port);
  server_->lengthen_queue();
  answer_watchers(*server_, run, port_);
  thread_ = std::thread([this] { server_->listen_after_bind(); });
  // What does not run yet cannot be stopped.
  while (!server_->is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

WatchServer::~WatchServer() {
  server_->end();
  thread_.join();
}

void WatchServer::bind(int port) {
  if (port == 0) {
    port_ = server_->bind_to_any_port(watch_address);
  } else if (server_->bind_to_port(watch_address, port)) {
    port_ = port;
  }
  if (port_ < 0) {
    throw ConfigError(fmt::format("--watch={}", port),
                      "the port is taken; choose another one, or --watch alone for any that is free");
  }
}

}  // namespace glocal::app
