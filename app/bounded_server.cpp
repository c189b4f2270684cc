#include "app/bounded_server.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <optional>
#include <string>

namespace glocal::app {
namespace {

using Clock = std::chrono::steady_clock;

/// Waits for the socket no longer than until then.
bool wait_for(socket_t socket, short events, Clock::time_point until) {
  pollfd waiting{socket, events, 0};
  int ready = -1;
  do {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now());
    if (left.count() <= 0) return false;
    ready = poll(&waiting, 1, static_cast<int>(left.count()));
  } while (ready < 0 && errno == EINTR);
  return ready == 1;
}

/// A socket with limits on what it brings and on how long it takes.
class BoundedStream final : public httplib::Stream {
 public:
  BoundedStream(socket_t socket, const ConnectionLimits& limits)
      : socket_(socket), limits_(limits), ask_until_(Clock::now() + limits.to_ask) {}

  [[nodiscard]] bool is_readable() const override {
    return at_ < filled_ || wait_for(socket_, POLLIN, ask_until_);
  }
  [[nodiscard]] bool is_writable() const override {
    return wait_for(socket_, POLLOUT, take_until_.value_or(Clock::now() + limits_.to_take));
  }

  ssize_t read(char* to, std::size_t size) override {
    if (at_ == filled_ && !fill()) return -1;
    const std::size_t n = std::min(size, filled_ - at_);
    std::copy_n(buffer_.begin() + static_cast<std::ptrdiff_t>(at_), n, to);
    at_ += n;
    return static_cast<ssize_t>(n);
  }

  ssize_t write(const char* from, std::size_t size) override {
    if (!take_until_) take_until_ = Clock::now() + limits_.to_take;
    if (!wait_for(socket_, POLLOUT, *take_until_)) return -1;
    return send(socket_, from, size, MSG_NOSIGNAL | MSG_DONTWAIT);
  }

  void get_remote_ip_and_port(std::string& /*ip*/, int& /*port*/) const override {}
  void get_local_ip_and_port(std::string& /*ip*/, int& /*port*/) const override {}
  [[nodiscard]] socket_t socket() const override { return socket_; }

 private:
  bool fill() {
    const std::size_t size = std::min(buffer_.size(), limits_.request_bytes - received_);
    if (size == 0 || !wait_for(socket_, POLLIN, ask_until_)) return false;
    const ssize_t n = recv(socket_, buffer_.data(), size, 0);
    if (n <= 0) return false;
    at_ = 0;
    filled_ = static_cast<std::size_t>(n);
    received_ += filled_;
    return true;
  }

  socket_t socket_;
  const ConnectionLimits& limits_;
  Clock::time_point ask_until_;
  std::optional<Clock::time_point> take_until_;  ///< None before the answer begins.
  std::array<char, 4096> buffer_{};
  std::size_t at_ = 0, filled_ = 0;
  std::size_t received_ = 0;
};

}  // namespace

bool Connections::enter(socket_t socket) {
  std::unique_lock lock(mutex_);
  if (open_.size() >= most_) {
    const auto silent = std::find_if(open_.begin(), open_.end(), [](const auto& c) { return !c.has_asked; });
    if (silent == open_.end()) return false;
    shutdown(silent->socket, SHUT_RDWR);
    constexpr std::chrono::milliseconds longest{100};
    left_.wait_for(lock, longest, [&] { return open_.size() < most_ || ended_; });
  }
  if (ended_ || open_.size() >= most_) return false;
  open_.push_back({socket});
  return true;
}

void Connections::has_asked(socket_t socket) {
  const std::lock_guard lock(mutex_);
  for (Connection& connection : open_) connection.has_asked |= connection.socket == socket;
}

void Connections::leave(socket_t socket) {
  const std::lock_guard lock(mutex_);
  std::erase_if(open_, [&](const Connection& connection) { return connection.socket == socket; });
  left_.notify_all();
}

void Connections::end(std::chrono::milliseconds grace) {
  std::unique_lock lock(mutex_);
  ended_ = true;
  for (const Connection& connection : open_) {
    if (!connection.has_asked) shutdown(connection.socket, SHUT_RDWR);
  }
  left_.wait_for(lock, grace, [&] { return open_.empty(); });
  for (const Connection& connection : open_) shutdown(connection.socket, SHUT_RDWR);
}

BoundedServer::BoundedServer(const ConnectionLimits& limits)
    : limits_(limits), connections_(limits.connections) {
  // A thread for each connection, and one that turns others away.
  new_task_queue = [threads = limits.connections + 1] {
    return new httplib::ThreadPool(threads);  // NOLINT: the library deletes it
  };
}

void BoundedServer::lengthen_queue() {
  ::listen(svr_sock_, static_cast<int>(limits_.connections));
}

void BoundedServer::end() {
  connections_.end(limits_.grace);
  stop();
}

void BoundedServer::answer(httplib::Stream& stream) {
  bool closed = false;
  process_request(stream, true, closed, [&](httplib::Request& request) {
    connections_.has_asked(stream.socket());
    // Whoever asks for parts gets the whole: a list of ranges may ask for it a thousand times.
    request.ranges.clear();
  });
}

bool BoundedServer::process_and_close_socket(socket_t socket) {
  if (connections_.enter(socket)) {
    BoundedStream stream(socket, limits_);
    answer(stream);
    connections_.leave(socket);
  }
  shutdown(socket, SHUT_RDWR);
  close(socket);
  return true;
}

}  // namespace glocal::app
