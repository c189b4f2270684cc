// Viewers that connect to the server, by a client of another part of its library. tests/foxglove has
// Foxglove's own.
#include "app/foxglove_server.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <optional>
#include <string>
#include <thread>

#include "files.hpp"

namespace glocal::test::foxglove_server_test {
namespace {

namespace asio = boost::asio;
namespace websocket = boost::beast::websocket;
using app::FoxgloveLimits;
using app::FoxgloveServer;
using boost::system::error_code;
using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;
using tcp = asio::ip::tcp;
using testing::HasSubstr;
using testing::StartsWith;

const LiveTopic map{"/map", "nav_msgs/OccupancyGrid"};
const LiveTopic scan{"/scan", "sensor_msgs/LaserScan"};
constexpr std::size_t megabyte = 1U << 20U;

/// A connection to a server on this machine.
class Socket {
 public:
  explicit Socket(const FoxgloveServer& server) : socket_(io_) {
    const std::string endpoint = server.endpoint();
    const int port = std::stoi(endpoint.substr(endpoint.rfind(':') + 1));
    socket_.connect({asio::ip::make_address("127.0.0.1"), static_cast<std::uint16_t>(port)});
  }
  /// What comes until the server closes the connection.
  std::string rest() {
    std::string rest;
    error_code error;
    for (std::string part(100, '\0'); !error;)
      rest += part.substr(0, socket_.read_some(asio::buffer(part), error));
    return rest;
  }

 protected:
  asio::io_context io_;
  tcp::socket socket_;
};

class Viewer : public Socket {
 public:
  explicit Viewer(const FoxgloveServer& server) : Socket(server), stream_(std::move(socket_)) {
    stream_.set_option(websocket::stream_base::decorator([](websocket::request_type& request) {
      request.set(boost::beast::http::field::sec_websocket_protocol, "foxglove.websocket.v1");
    }));
    stream_.handshake("127.0.0.1", "/");
  }
  void subscribe(int channel) {
    const std::string text =
        fmt::format(R"({{"op": "subscribe", "subscriptions": [{{"id": 1, "channelId": {}}}]}})", channel);
    stream_.text(true);
    stream_.write(asio::buffer(text));
  }
  /// The next message without what comes before the payload of binary ones; none once the connection is
  /// closed.
  std::optional<std::string> next() {
    constexpr std::size_t head = 13;
    boost::beast::flat_buffer buffer;
    error_code error;
    stream_.read(buffer, error);
    if (error) return std::nullopt;
    const std::string bytes = boost::beast::buffers_to_string(buffer.data());
    return stream_.got_binary() ? bytes.substr(head) : bytes;
  }
  /// The next of which this is a part.
  std::string next_with(const std::string& part) {
    while (const auto message = next()) {
      if (message->find(part) != std::string::npos) return *message;
    }
    return "closed";
  }

 private:
  websocket::stream<tcp::socket> stream_;
};

TEST(FoxgloveServer, SendsWhatIsKeptToThoseWhoComeLate) {
  FoxgloveServer server("127.0.0.1", 0);
  EXPECT_THAT(server.endpoint(), StartsWith("127.0.0.1:"));
  server.offer(map, 1, "the first map", true);
  server.offer(map, 2, "the second map", true);
  server.offer(scan, 2, "a scan that is over");
  Viewer viewer(server);
  viewer.next_with("/scan");
  viewer.subscribe(0);
  EXPECT_EQ(viewer.next(), "the second map");
  viewer.subscribe(1);
  // An id may be used once.
  EXPECT_THAT(viewer.next(), testing::Optional(HasSubstr("needs an id of its own")));
}

TEST(FoxgloveServer, LosesNothingThatIsKept) {
  FoxgloveServer server("127.0.0.1", 0);
  // More than may wait for its thread, and so soon after one another that it has hardly begun.
  constexpr int mounts = 100;
  server.offer(map, 1, std::string(20 * megabyte, ' '), true);
  for (int i = 1; i <= mounts; ++i)
    server.offer({fmt::format("/robot_{}/tf_static", i), "tf2_msgs/TFMessage"}, 1, "mounts", true);
  std::this_thread::sleep_for(milliseconds(100));
  server.offer(scan, 2, "the last one", true);
  Viewer viewer(server);
  viewer.next_with(scan.name);
  viewer.subscribe(mounts);
  EXPECT_EQ(viewer.next(), "mounts");
}

TEST(FoxgloveServer, TellsOfTopicsAsTheyAreFirstSeen) {
  FoxgloveServer server("127.0.0.1", 0);
  Viewer viewer(server);
  EXPECT_THAT(viewer.next(), testing::Optional(HasSubstr("serverInfo")));
  EXPECT_THAT(viewer.next(), testing::Optional(HasSubstr("\"channels\":[]")));
  server.offer(scan, 1, "a scan");
  EXPECT_THAT(viewer.next(), testing::Optional(HasSubstr("/scan")));
  viewer.subscribe(0);
  // When the subscription has come, is not known.
  std::jthread robot([&](const std::stop_token& stop) {
    for (int i = 0; !stop.stop_requested(); ++i) {
      server.offer(scan, i, "another scan");
      std::this_thread::sleep_for(milliseconds(5));
    }
  });
  EXPECT_EQ(viewer.next(), "another scan");
}

TEST(FoxgloveServer, IsHeldUpByNoSlowViewer) {
  // However busy the machine is, nobody is taken for dead.
  FoxgloveLimits limits;
  limits.connection.to_take = std::chrono::minutes(10);
  FoxgloveServer server("127.0.0.1", 0, limits);
  server.offer(scan, 0, "kept", true);
  Viewer slow(server), silent(server);
  const Socket says_nothing(server);
  for (Viewer* viewer : {&slow, &silent}) {
    viewer->next_with("/scan");
    viewer->subscribe(0);
    EXPECT_EQ(viewer->next(), "kept");
  }
  auto longest = steady_clock::duration::zero();
  constexpr int messages = 300;
  const std::string blank(megabyte, ' ');
  for (int i = 0; i <= messages; ++i) {
    const std::string bytes = fmt::format("scan {} ", i) + blank;
    const auto begun = steady_clock::now();
    server.offer(scan, i, bytes);
    longest = std::max(longest, steady_clock::now() - begun);
    std::this_thread::sleep_for(milliseconds(1));
  }
  EXPECT_LT(longest, seconds(5));
  int received = 0, last = -1;
  while (last < messages) {
    const auto message = slow.next();
    ASSERT_TRUE(message);
    const int number = std::stoi(message->substr(5));
    EXPECT_GT(number, last);
    last = number;
    ++received;
  }
  // What waits for it, and what the system's buffers hold.
  EXPECT_GE(received, 10);
  EXPECT_LT(received, messages / 2);
}

TEST(FoxgloveServer, EndsThoughAViewerReadsNothing) {
  auto server = std::make_unique<FoxgloveServer>("127.0.0.1", 0);
  server->offer(map, 0, std::string(64 * megabyte, ' '), true);
  Viewer viewer(*server);
  viewer.next_with("/map");
  viewer.subscribe(0);
  Socket says_nothing(*server);
  const auto begun = steady_clock::now();
  server.reset();
  EXPECT_LT(steady_clock::now() - begun, seconds(10));
  EXPECT_EQ(says_nothing.rest(), "");
}

TEST(FoxgloveServer, SendsWhatWaitsBeforeItEnds) {
  FoxgloveLimits limits;
  limits.connection.grace = seconds(10);
  auto server = std::make_unique<FoxgloveServer>("127.0.0.1", 0, limits);
  server->offer(scan, 0, "kept", true);
  Viewer viewer(*server);
  viewer.next_with("/scan");
  viewer.subscribe(0);
  EXPECT_EQ(viewer.next(), "kept");
  for (int i = 0; i < 100; ++i) server->offer(scan, i, fmt::format("{}", i));
  std::jthread ends([&] { server.reset(); });
  for (int i = 0; i < 100; ++i) EXPECT_EQ(viewer.next(), fmt::format("{}", i));
  EXPECT_EQ(viewer.next(), std::nullopt);
}

TEST(FoxgloveServer, TurnsAwayWhoAsksForNothingAndWhoIsTooMany) {
  FoxgloveLimits limits;
  limits.connection.connections = 2;
  limits.connection.to_ask = milliseconds(300);
  FoxgloveServer server("127.0.0.1", 0, limits);
  auto viewer = std::make_unique<Viewer>(server);
  {
    Socket silent(server), third(server);
    EXPECT_EQ(third.rest(), "");
    const auto begun = steady_clock::now();
    EXPECT_EQ(silent.rest(), "");
    EXPECT_LT(steady_clock::now() - begun, seconds(5));
  }
  Viewer second(server);
  EXPECT_THAT(second.next(), testing::Optional(HasSubstr("serverInfo")));
}

TEST(FoxgloveServer, SaysWhereItCannotListen) {
  const TemporaryFolder folder;
  const FoxgloveServer first("127.0.0.1", 0);
  const int port = std::stoi(first.endpoint().substr(first.endpoint().rfind(':') + 1));
  const auto error_of = [&](const std::string& address, int wanted) {
    return config_error(folder.path(), [&] { FoxgloveServer(address, wanted); });
  };
  EXPECT_EQ(
      error_of("127.0.0.1", port),
      fmt::format("--port={}: error: the port is taken; choose another one, or --port 0 for any that is "
                  "free",
                  port));
  EXPECT_THAT(error_of("localhost", port), HasSubstr("--address=localhost: error: is no IP address"));
  EXPECT_THAT(error_of("192.0.2.1", 0),
              HasSubstr("--address=192.0.2.1: error: port 0 cannot be listened to"));
}

}  // namespace
}  // namespace glocal::test::foxglove_server_test
