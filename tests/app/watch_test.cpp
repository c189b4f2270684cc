// glocal run --watch.
#include <arpa/inet.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <httplib.h>
// A macro of <resolv.h>, which httplib brings, and a name of Eigen's.
#undef _res
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "app/room.hpp"
#include "report/unpacked.hpp"

namespace glocal::test::watch_test {
namespace {

using testing::HasSubstr;

/// Asks again and again; false if it has not come true after a minute.
bool wait_for(const std::function<bool()>& condition) {
  for (int i = 0; i < 3000; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return false;
}

/// Of the address that the program has told; 0 if it has told none yet.
int port_in(const std::string& said) {
  const std::string before = "watch: http://127.0.0.1:";
  const std::size_t at = said.find(before);
  if (at == std::string::npos || said.find("/\n", at + before.size()) == std::string::npos) return 0;
  return std::stoi(said.substr(at + before.size()));
}

/// A connection that asks for nothing by itself.
class Connection {
 public:
  explicit Connection(int port) : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);  // NOLINT
  }
  ~Connection() { close(socket_); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// False if nobody listens any more.
  [[nodiscard]] bool say(const std::string& text) const {
    return send(socket_, text.data(), text.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(text.size());
  }

 private:
  int socket_;
};

class WatchedRun : public Room {
 protected:
  WatchedRun() { write_experiment("trials: {every_scan: 6, max_steps: 5}\n", "output: {maps: all}\n"); }

  ~WatchedRun() override {
    if (!program_.joinable()) return;
    signal(SIGKILL);
    program_.join();
  }

  /// Starts a run of about a hundred slow steps and waits until it can be watched.
  void start(const std::string& options = "") {
    const std::string command = fmt::format(
        "echo $$ >{0}/pid; exec {1} run {0}/room.yaml --quiet --watch --out {0}/watched {2} >{0}/out "
        "2>{0}/err",
        folder_.path().string(), GLOCAL_PROGRAM, options);
    program_ = std::thread([this, command] { status_ = std::system(command.c_str()); });
    ASSERT_TRUE(wait_for([&] { return (port_ = port_in(content(file("err")))) != 0; }))
        << content(file("err"));
  }

  void signal(int number) const { kill(std::stoi(content(file("pid"))), number); }

  [[nodiscard]] int exit_code() {
    program_.join();
    return WIFEXITED(status_) ? WEXITSTATUS(status_) : -1;
  }

  [[nodiscard]] httplib::Client client() const { return httplib::Client("127.0.0.1", port_); }

  /// The data, once it is as wanted.
  Json data_with(const std::function<bool(const Json&)>& is_wanted) {
    Json data;
    EXPECT_TRUE(wait_for([&] {
      const auto answer = client().Get("/data");
      if (!answer) return false;
      data = Json::parse(answer->body);
      return is_wanted(data);
    }));
    return data;
  }

  static constexpr const char* slow = "--set localizer.matcher.ransam.iterations=400000";
  int port_ = 0;

 private:
  std::thread program_;
  int status_ = -1;
};

TEST_F(WatchedRun, IsShownWhileItGoesOnAndToTheEnd) {
  start(slow);
  const auto page = client().Get("/");
  ASSERT_TRUE(page);
  EXPECT_EQ(page->status, 200);
  EXPECT_THAT(page->body, HasSubstr("<title>room</title>"));
  EXPECT_EQ(data_in(page->body).head["live"]["experiment"], "room");
  EXPECT_EQ(page->get_header_value("Cache-Control"), "no-store");
  EXPECT_THAT(page->get_header_value("Content-Security-Policy"), HasSubstr("default-src 'none'"));
  const Json running = data_with([](const Json& data) {
    const Json& trials = data["runs"][0]["trials"];
    return !trials.empty() && !trials.back().contains("outcome");
  });
  const Json trial = running["runs"][0]["trials"].back();
  EXPECT_EQ(trial["local_map"]["steps"].size(), 1U);
  EXPECT_EQ(trial["local_map"]["steps"][0], trial["columns"]["step"].back());
  EXPECT_GT(trial["local_map"]["x"].size(), 50U);
  EXPECT_GT(trial["scans"]["x"].size(), 50U);
  const Json last = data_with([](const Json& data) { return data["live"]["finished"] == true; });
  EXPECT_EQ(exit_code(), 0) << content("err");
  const Json& live = last["live"];
  EXPECT_EQ(live["trials_done"], live["trials"]);
  std::size_t n = 0;
  for (const Json& line : json_lines("watched/trials.jsonl")) {
    Json shown = last["runs"][0]["trials"][n];
    EXPECT_EQ(shown["columns"]["step"].size(), 5U - (n == 3 ? 1U : 0U));
    shown.erase("columns");
    EXPECT_EQ(shown, line);
    ++n;
  }
  EXPECT_EQ(last["runs"][0]["trials"].size(), n);
  EXPECT_FALSE(client().Get("/data"));
}

TEST_F(WatchedRun, HasTheResultsOfOneThatIsNot) {
  good(run_room("alone", std::string("--quiet ") + slow));
  start(std::string(slow) + " --jobs 2");
  data_with([](const Json& data) { return data["live"]["trials_done"] >= 1; });
  ASSERT_EQ(exit_code(), 0);
  expect_same_results("alone", "watched");
  EXPECT_EQ(content("alone/effective.yaml"), content("watched/effective.yaml"));
}

TEST_F(WatchedRun, AnswersOnlyWhatItsOwnPageAsks) {
  start(slow);
  for (const char* path : {"/data/", "/x", "/../../etc/passwd", "/data%00"}) {
    const auto answer = client().Get(path);
    ASSERT_TRUE(answer) << path;
    EXPECT_EQ(answer->status, 404) << path;
  }
  for (const char* host : {"example.org", "127.0.0.1", "127.0.0.1:1", ""}) {
    const auto answer = client().Get("/data", {{"Host", host}});
    ASSERT_TRUE(answer) << host;
    EXPECT_EQ(answer->status, 403) << host;
    EXPECT_EQ(answer->body, "");
  }
  EXPECT_EQ(client().Get("/data", {{"Host", fmt::format("localhost:{}", port_)}})->status, 200);
  EXPECT_EQ(client().Post("/data", "x", "text/plain")->status, 405);
  EXPECT_EQ(client().Delete("/")->status, 405);
  EXPECT_EQ(client().Head("/")->status, 405);
  EXPECT_EQ(client().Get("/data?version=other")->status, 200);
  // What is known is not told again.
  EXPECT_TRUE(wait_for([&] {
    const Json data = Json::parse(client().Get("/data")->body);
    return client().Get(fmt::format("/data?version={}", data["live"]["version"].get<int>()))->status == 204;
  }));
}

TEST_F(WatchedRun, EndsInGoodOrderWhoeverIsConnected) {
  start(slow);
  const Connection idle(port_);
  data_with([](const Json& data) { return data["live"]["trials_done"] >= 1; });
  signal(SIGINT);
  EXPECT_EQ(exit_code(), 3);
  EXPECT_EQ(json("watched/summary.json")["complete"], false);
}

TEST_F(WatchedRun, EndsThoughClientsAreSlow) {
  start(slow);
  std::vector<std::unique_ptr<Connection>> clients;
  for (int i = 0; i < 8; ++i) clients.push_back(std::make_unique<Connection>(port_));
  std::atomic<bool> ended = false;
  const std::jthread talkers([&] {
    for (int i = 0; i < 100 && !ended; ++i) {
      for (const auto& client : clients) static_cast<void>(client->say(i == 0 ? "G" : "x"));
      std::this_thread::sleep_for(std::chrono::milliseconds(300));
    }
  });
  data_with([](const Json& data) { return data["live"]["trials_done"] >= 1; });
  signal(SIGINT);
  const auto asked = std::chrono::steady_clock::now();
  EXPECT_EQ(exit_code(), 3);
  ended = true;
  // Not as long as somebody talks, which is half a minute.
  EXPECT_LT(std::chrono::steady_clock::now() - asked, std::chrono::seconds(10));
}

TEST_F(WatchedRun, AnswersThoughManyAreConnected) {
  start("--set localizer.matcher.ransam.iterations=10000000");
  std::vector<std::unique_ptr<Connection>> idle;
  for (int i = 0; i < 200; ++i) idle.push_back(std::make_unique<Connection>(port_));
  httplib::Client client("127.0.0.1", port_);
  client.set_read_timeout(30);  // a second for each four of them would be more
  const auto answer = client.Get("/data");
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 200);
}

TEST_F(WatchedRun, AnswersNoMoreThanThePage) {
  start(slow);
  std::string ranges = "bytes=0-";
  for (int i = 0; i < 200; ++i) ranges += ",0-";
  const auto answer = client().Get("/", {{"Range", ranges}});
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 200);
  EXPECT_EQ(answer->get_header_value("Content-Type"), "text/html; charset=utf-8");
  EXPECT_THAT(answer->body, testing::StartsWith("<!doctype html>"));
}

TEST_F(WatchedRun, ReadsNoMoreThanARequestTakes) {
  start(slow);
  httplib::Headers many;
  for (int i = 0; i < 1000; ++i) many.emplace("X-Header", "more and more of them");
  const auto answer = client().Get("/", many);
  EXPECT_TRUE(!answer || answer->status == 400);
  const Connection endless(port_);
  EXPECT_TRUE(wait_for([&] { return !endless.say(std::string(4096, 'G')); }));
  EXPECT_EQ(client().Get("/data")->status, 200);
}

TEST_F(WatchedRun, WantsAPortOfItsOwn) {
  httplib::Server other;
  const int port = other.bind_to_any_port("127.0.0.1");
  EXPECT_EQ(refusal(run_room("a", fmt::format("--quiet --watch={}", port))),
            fmt::format(
                "--watch={}: error: the port is taken; choose another one, or --watch alone for any that is "
                "free\n1 error\n",
                port));
  for (const char* wrong : {"--watch=80", "--watch=65536", "--watch=-1", "--watch=x"})
    EXPECT_EQ(run_room("a", wrong).exit_code, 2) << wrong;
  for (const auto& entry : fs::directory_iterator(folder_.path()))
    EXPECT_THAT(entry.path().filename().string(), testing::AnyOf("out", "err", "room.yaml", "world.yaml"));
}

}  // namespace
}  // namespace glocal::test::watch_test
