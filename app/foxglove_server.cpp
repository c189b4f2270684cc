#include "app/foxglove_server.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <future>
#include <optional>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

#include "app/foxglove_client.hpp"
#include "glocal/error.hpp"

namespace glocal::app {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using boost::system::error_code;
using tcp = asio::ip::tcp;

/// The newer one is the older one with more that servers may offer.
constexpr std::array<std::string_view, 2> protocols = {"foxglove.sdk.v1", "foxglove.websocket.v1"};

/// The first that the viewer names and that is known here; empty if there is none.
std::string protocol_of(const http::request<http::empty_body>& request) {
  for (const auto name : http::token_list(request[http::field::sec_websocket_protocol])) {
    if (std::find(protocols.begin(), protocols.end(), std::string_view(name.data(), name.size())) !=
        protocols.end())
      return std::string(name);
  }
  return {};
}

class Session;

/// What sessions share; all of it belongs to the server's thread.
struct Shared {
  FoxgloveLimits limits;
  std::vector<FoxgloveChannel> channels;
  std::set<std::shared_ptr<Session>> sessions;
};

/// A connection, from its request on.
class Session : public std::enable_shared_from_this<Session> {
  /// What follows when this has been done; where it could not be, the viewer has left.
  auto then(void (Session::*next)()) {
    return [self = shared_from_this(), next](const error_code& error, std::size_t = 0) {
      error ? self->leave() : (self.get()->*next)();
    };
  }

 public:
  Session(tcp::socket socket, Shared& shared)
      : stream_(std::move(socket)), shared_(shared), client_(shared.channels, shared.limits.queue_bytes) {}

  void start() {
    beast::get_lowest_layer(stream_).expires_after(shared_.limits.connection.to_ask);
    request_.header_limit(static_cast<std::uint32_t>(shared_.limits.connection.request_bytes));
    http::async_read(stream_.next_layer(), buffer_, request_, then(&Session::take_request));
  }

  void advertise(std::size_t first) {
    client_.advertise(first);
    write();
  }
  void offer(std::uint32_t channel, const std::shared_ptr<const FoxgloveMessage>& message) {
    client_.offer(channel, message);
    write();
  }
  /// Closes the connection once all that waits is sent.
  void end() {
    is_ending_ = true;
    if (!is_open_) return leave();
    write();
  }

 private:
  void leave() {
    beast::get_lowest_layer(stream_).close();
    shared_.sessions.erase(shared_from_this());
  }

  void take_request() {
    const std::string protocol = protocol_of(request_.get());
    beast::get_lowest_layer(stream_).expires_never();
    stream_.set_option(websocket::stream_base::timeout{
        shared_.limits.connection.to_ask, shared_.limits.connection.to_take, true /* Asks who is silent. */});
    // A viewer that knows other protocols only leaves by itself; who sends no handshake is refused by accept.
    stream_.set_option(websocket::stream_base::decorator([protocol](websocket::response_type& response) {
      if (!protocol.empty()) response.set(http::field::sec_websocket_protocol, protocol);
    }));
    stream_.read_message_max(shared_.limits.connection.request_bytes);
    stream_.auto_fragment(false);
    stream_.async_accept(request_.get(), then(&Session::open));
  }

  void open() {
    is_open_ = true;
    read();
    write();
  }

  void read() {
    buffer_.clear();
    stream_.async_read(buffer_, then(&Session::take));
  }

  void take() {
    if (stream_.got_text()) {
      client_.take({static_cast<const char*>(buffer_.cdata().data()), buffer_.size()});
    } else {
      client_.take_binary();
    }
    write();
    read();
  }

  void write() {
    if (!is_open_ || writing_) return;
    writing_ = client_.next();
    if (!writing_) {
      if (is_ending_) close();
      return;
    }
    stream_.text(writing_->is_text());
    const auto body = writing_->is_text() ? asio::const_buffer() : asio::buffer(writing_->message->bytes);
    stream_.async_write(std::array<asio::const_buffer, 2>{asio::buffer(writing_->head), body},
                        then(&Session::written));
  }

  void written() {
    writing_.reset();
    write();
  }

  void close() {
    is_open_ = false;
    stream_.async_close(websocket::close_code::going_away, then(&Session::leave));
  }

  websocket::stream<beast::tcp_stream> stream_;
  Shared& shared_;
  beast::flat_buffer buffer_;
  http::request_parser<http::empty_body> request_;
  FoxgloveClient client_;
  std::optional<FoxgloveFrame> writing_;
  bool is_open_ = false, is_ending_ = false;
};

tcp::endpoint endpoint_of(const std::string& address, int port) {
  error_code error;
  const auto ip = asio::ip::make_address(address, error);
  if (error)
    throw ConfigError(fmt::format("--address={}", address),
                      "is no IP address: 127.0.0.1 is this machine alone, 0.0.0.0 all of its networks");
  return {ip, static_cast<std::uint16_t>(port)};
}

}  // namespace

class FoxgloveServer::Server {
 public:
  Server(const tcp::endpoint& endpoint, const FoxgloveLimits& limits) : shared_{limits, {}, {}} {
    bind(endpoint);
    endpoint_ = (std::ostringstream() << acceptor_.local_endpoint()).str();
    accept();
    ended_ = std::async(std::launch::async, [this] { io_.run(); });
  }

  ~Server() {
    asio::post(io_, [this] {
      acceptor_.close();
      // A session that ends leaves the set.
      const auto sessions = shared_.sessions;
      for (const auto& session : sessions) session->end();
    });
    ended_.wait_for(shared_.limits.connection.grace);
    io_.stop();
    ended_.wait();
  }

  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  [[nodiscard]] const std::string& endpoint() const { return endpoint_; }

  void offer(const LiveTopic& topic, std::shared_ptr<const FoxgloveMessage> message, bool is_kept) {
    const std::size_t size = sizeof(FoxgloveMessage) + message->bytes.size();
    // Where the thread gets no processor, messages are lost, not memory. What is kept is sent only once.
    if (!is_kept && waiting_bytes_ > shared_.limits.queue_bytes) return;
    waiting_bytes_ += size;
    asio::post(io_, [this, topic, message = std::move(message), is_kept, size] {
      waiting_bytes_ -= size;
      const std::uint32_t channel = channel_of(topic);
      if (is_kept) shared_.channels[channel].kept = message;
      for (const auto& session : shared_.sessions) session->offer(channel, message);
    });
  }

 private:
  void bind(const tcp::endpoint& endpoint) {
    error_code error;
    acceptor_.open(endpoint.protocol(), error);
    if (!error) acceptor_.set_option(tcp::acceptor::reuse_address(true), error);
    if (!error) acceptor_.bind(endpoint, error);
    if (!error) acceptor_.listen(static_cast<int>(shared_.limits.connection.connections), error);
    if (error == asio::error::address_in_use)
      throw ConfigError(fmt::format("--port={}", endpoint.port()),
                        "the port is taken; choose another one, or --port 0 for any that is free");
    if (error)
      throw ConfigError(fmt::format("--address={}", endpoint.address().to_string()),
                        fmt::format("port {} cannot be listened to: {}", endpoint.port(), error.message()));
  }

  void accept() {
    acceptor_.async_accept([this](const error_code& error, tcp::socket socket) {
      if (!acceptor_.is_open()) return;
      if (error) return accept_later();
      if (shared_.sessions.size() < shared_.limits.connection.connections)
        (*shared_.sessions.insert(std::make_shared<Session>(std::move(socket), shared_)).first)->start();
      accept();
    });
  }

  /// As long as the process has no room for another connection, each try fails at once.
  void accept_later() {
    constexpr std::chrono::milliseconds pause{100};
    pause_.expires_after(pause);
    pause_.async_wait([this](const error_code& /*error*/) {
      if (acceptor_.is_open()) accept();
    });
  }

  std::uint32_t channel_of(const LiveTopic& topic) {
    auto& channels = shared_.channels;
    const auto found = std::find_if(channels.begin(), channels.end(),
                                    [&](const auto& channel) { return channel.topic.name == topic.name; });
    const auto channel = static_cast<std::uint32_t>(found - channels.begin());
    if (found == channels.end()) {
      channels.push_back({topic, nullptr});
      for (const auto& session : shared_.sessions) session->advertise(channel);
    }
    return channel;
  }

  asio::io_context io_;
  tcp::acceptor acceptor_{io_};
  asio::steady_timer pause_{io_};
  std::string endpoint_;
  Shared shared_;
  std::atomic<std::size_t> waiting_bytes_ = 0;  ///< For the thread.
  std::future<void> ended_;
};

FoxgloveServer::FoxgloveServer(const std::string& address, int port, const FoxgloveLimits& limits)
    : server_(std::make_unique<Server>(endpoint_of(address, port), limits)) {}
FoxgloveServer::~FoxgloveServer() = default;

std::string FoxgloveServer::endpoint() const {
  return server_->endpoint();
}

void FoxgloveServer::offer(const LiveTopic& topic, std::int64_t stamp_ns, std::string_view bytes,
                           bool is_kept) {
  server_->offer(
      topic, std::make_shared<const FoxgloveMessage>(FoxgloveMessage{stamp_ns, std::string(bytes)}), is_kept);
}

}  // namespace glocal::app
