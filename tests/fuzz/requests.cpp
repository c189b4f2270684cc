// What is sent to the server of `glocal run --watch`.
#include <algorithm>
#include <string>

#include "app/bounded_server.hpp"
#include "app/watch_requests.hpp"
#include "fuzz/harness.hpp"
#include "report/page_text.hpp"

namespace glocal::fuzz {
namespace {

constexpr int port = 8080;

/// Brings the input, and keeps the answer.
class Conversation final : public httplib::Stream {
 public:
  explicit Conversation(std::string input) : input_(std::move(input)) {}

  [[nodiscard]] bool is_readable() const override { return at_ < input_.size(); }
  [[nodiscard]] bool is_writable() const override { return true; }
  ssize_t read(char* to, std::size_t size) override {
    const std::size_t n = std::min(size, input_.size() - at_);
    std::copy_n(input_.data() + at_, n, to);
    at_ += n;
    return n == 0 ? -1 : static_cast<ssize_t>(n);
  }
  ssize_t write(const char* from, std::size_t size) override {
    answer_.append(from, size);
    return static_cast<ssize_t>(size);
  }
  void get_remote_ip_and_port(std::string& /*ip*/, int& /*port*/) const override {}
  void get_local_ip_and_port(std::string& /*ip*/, int& /*port*/) const override {}
  [[nodiscard]] socket_t socket() const override { return INVALID_SOCKET; }
  [[nodiscard]] const std::string& answer() const { return answer_; }

 private:
  std::string input_, answer_;
  std::size_t at_ = 0;
};

/// Of a run that has not begun.
struct Watched {
  LiveRun run{"fuzz"};
  app::BoundedServer server;
  Watched() { app::answer_watchers(server, run, port); }
};

}  // namespace
}  // namespace glocal::fuzz

extern "C" int fuzz_requests(const std::uint8_t* data, std::size_t size) {
  using namespace glocal;
  static fuzz::Watched watched;
  fuzz::Conversation conversation(fuzz::text_of(data, size));
  watched.server.answer(conversation);
  const std::string& answer = conversation.answer();
  fuzz::must_hold(answer.empty() || answer.starts_with("HTTP/1.1 "), "an answer has a status");
  constexpr std::size_t around_page = 10'000;
  fuzz::must_hold(answer.size() <= page_text.size() + around_page, "no answer is more than the page");
  return 0;
}
