#include "app/watch_server.hpp"

#include <fmt/format.h>
#include <httplib.h>

#include <charconv>
#include <chrono>
#include <optional>
#include <string>
#include <thread>

#include "glocal/error.hpp"
#include "report/page.hpp"
#include "report/page_text.hpp"

namespace glocal::app {
namespace {

constexpr const char* address = "127.0.0.1";

/// Connections are short, and idle ones must not keep the program from ending.
constexpr int timeout_s = 1;
constexpr std::size_t threads = 4;

const httplib::Headers& headers() {
  static const httplib::Headers all = {
      {"Cache-Control", "no-store"},
      {"Content-Security-Policy",
       "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:; "
       "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
      {"X-Content-Type-Options", "nosniff"},
      {"Referrer-Policy", "no-referrer"}};
  return all;
}

/// The library's own options let a second program listen on the same port.
void only_listener(socket_t socket) {
  const int yes = 1;
  setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
}

std::optional<std::uint64_t> version_of(const httplib::Request& request) {
  const std::string text = request.get_param_value("version");
  std::uint64_t version = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), version);
  const bool is_number = error == std::errc{} && end == text.data() + text.size();
  return is_number ? std::optional(version) : std::nullopt;
}

}  // namespace

class WatchServer::Server {
 public:
  Server(int port, LiveRun& run) : run_(run) {
    server_.set_socket_options(only_listener);
    server_.set_default_headers(headers());
    server_.set_keep_alive_max_count(1);
    server_.set_keep_alive_timeout(timeout_s);
    server_.set_read_timeout(timeout_s);
    server_.set_write_timeout(timeout_s);
    server_.new_task_queue = [] {
      return new httplib::ThreadPool(threads);
    };  // NOLINT: the library deletes it
    server_.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      response.status = answer(request, response);
      return httplib::Server::HandlerResponse::Handled;
    });
    bind(port);
    thread_ = std::thread([this] { server_.listen_after_bind(); });
    // What does not run yet cannot be stopped.
    while (!server_.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

  ~Server() {
    server_.stop();
    thread_.join();
  }

  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  [[nodiscard]] int port() const { return port_; }

 private:
  void bind(int port) {
    port_ = port == 0 ? server_.bind_to_any_port(address) : server_.bind_to_port(address, port) ? port : -1;
    if (port_ < 0) {
      throw ConfigError({{fmt::format("--watch={}", port), 0, 0,
                          "the port is taken; choose another one, or --watch alone for any that is free"}});
    }
  }

  /// The status.
  int answer(const httplib::Request& request, httplib::Response& response) {
    // Other names may have been made to point here by a page from elsewhere.
    const std::string host = request.get_header_value("Host");
    if (host != fmt::format("{}:{}", address, port_) && host != fmt::format("localhost:{}", port_))
      return 403;
    if (request.path != "/" && request.path != "/data") return 404;
    if (request.method != "GET") {
      response.set_header("Allow", "GET");
      return 405;
    }
    const bool is_page = request.path == "/";
    const auto news = run_.news(is_page ? std::nullopt : version_of(request));
    if (!news) return 204;
    if (is_page) {
      response.set_content(page_with(page_text, news->data["runs"][0]["name"], news->data),
                           "text/html; charset=utf-8");
    } else {
      response.set_content(json_text(news->data), "application/json");
    }
    run_.told(news->version);
    return 200;
  }

  LiveRun& run_;
  httplib::Server server_;
  int port_ = -1;
  std::thread thread_;
};

WatchServer::WatchServer(int port, LiveRun& run) : server_(std::make_unique<Server>(port, run)) {}
WatchServer::~WatchServer() = default;

int WatchServer::port() const {
  return server_->port();
}

}  // namespace glocal::app
