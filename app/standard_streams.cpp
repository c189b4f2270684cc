#include "app/standard_streams.hpp"

#include <fcntl.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <iostream>
#include <memory>
#include <mutex>
#include <set>

#include "glocal/error.hpp"
#include "glocal/words.hpp"

namespace glocal::app {
namespace {

void write_to_stderr(const std::string& text) {
  static_cast<void>(std::fputs(text.c_str(), stderr));
}

/// The words of a log's line.
class FitWords final : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& message, const std::tm& /*time*/,
              spdlog::memory_buf_t& line) override {
    const std::string text = fit_message({message.payload.data(), message.payload.size()});
    line.append(text.data(), text.data() + text.size());
  }
  [[nodiscard]] std::unique_ptr<custom_flag_formatter> clone() const override {
    return std::make_unique<FitWords>();
  }
};

/// Passes on each warning once: what the next variant or case says again of the same file tells nobody
/// anything.
class WarningsOnce final : public spdlog::sinks::sink {
 public:
  explicit WarningsOnce(spdlog::sink_ptr to) : to_(std::move(to)) {}

  void log(const spdlog::details::log_msg& message) override {
    if (message.level == spdlog::level::warn && !is_new({message.payload.data(), message.payload.size()}))
      return;
    to_->log(message);
  }
  void flush() override { to_->flush(); }
  void set_pattern(const std::string& pattern) override { to_->set_pattern(pattern); }
  void set_formatter(std::unique_ptr<spdlog::formatter> formatter) override {
    to_->set_formatter(std::move(formatter));
  }

 private:
  [[nodiscard]] bool is_new(std::string warning) {
    const std::lock_guard lock(mutex_);
    return said_.insert(std::move(warning)).second;
  }

  spdlog::sink_ptr to_;
  std::mutex mutex_;
  std::set<std::string> said_;
};

}  // namespace

void keep_standard_streams() {
  // In rising order: each takes the lowest number that is free. What is written to one that was closed fails.
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(stream, F_GETFD) == -1 && errno == EBADF)
      static_cast<void>(open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY));
  }
}

void answer(const std::string& text) {
  fmt::print("{}", printable(text));
}

void answer_on_cleared_screen(const std::string& text) {
  fmt::print("\033[H\033[J{}", printable(text));
}

void say(const std::string& text) {
  write_to_stderr(fit_message(text));
}

void say_over(const std::string& text) {
  write_to_stderr("\r\033[K" + fit_message(text));
}

void log_to_stderr() {
  auto formatter = std::make_unique<spdlog::pattern_formatter>();
  formatter->add_flag<FitWords>('*').set_pattern("%^%l%$: %*");
  auto sink = std::make_shared<WarningsOnce>(std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
  spdlog::set_default_logger(std::make_shared<spdlog::logger>("glocal", std::move(sink)));
  spdlog::set_formatter(std::move(formatter));
}

void warn(const std::string& text) {
  spdlog::warn("{}", text);
}

std::string text_bar(double share) {
  constexpr int width = 30;
  const auto filled = static_cast<int>(share * width);
  return fmt::format("[{:#<{}}{:.<{}}]", "", filled, "", width - filled);
}

void flush_answers() {
  std::cout.flush();
  if (!std::cout || std::fflush(stdout) != 0)
    throw RunError("the answer could not be written to standard output");
}

}  // namespace glocal::app
