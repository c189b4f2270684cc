#include "progress.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace glocal::app {
namespace {

constexpr std::chrono::milliseconds between_bars{100};
constexpr std::chrono::minutes between_lines{1};

}  // namespace

Progress::Progress(bool shown, std::size_t trials)
    : shown_(shown), on_terminal_(isatty(STDERR_FILENO) == 1), trials_(static_cast<double>(trials)) {}

Progress::~Progress() {
  if (shown_ && on_terminal_) std::fputs("\r\033[K", stderr);
}

void Progress::begin(const std::string& what) {
  const std::lock_guard lock(mutex_);
  what_ = what.empty() ? "" : what + ", ";
}

void Progress::step(std::size_t trial, std::size_t step, double share, const char* verdict) {
  const std::lock_guard lock(mutex_);
  running_[trial] = share;
  const auto now = Clock::now();
  if (!shown_ || now - last_ < (on_terminal_ ? Clock::duration(between_bars) : between_lines)) return;
  last_ = now;
  const double share_done = std::min(1.0, done() / trials_);
  if (!on_terminal_) {
    spdlog::info("{}{} of {:.0f} trials done{}", what_, finished_, trials_, time_left(share_done));
    return;
  }
  constexpr int width = 30;
  const auto filled = static_cast<int>(share_done * width);
  fmt::print(stderr, "\r\033[K[{:#<{}}{:.<{}}] {} of {:.0f}{}  {}trial {}, step {}  {}", "", filled, "",
             width - filled, finished_, trials_, time_left(share_done), what_, trial, step, verdict);
  std::fflush(stderr);
}

void Progress::finish(std::size_t trial) {
  const std::lock_guard lock(mutex_);
  running_.erase(trial);
  ++finished_;
}

void Progress::skip(std::size_t trials) {
  const std::lock_guard lock(mutex_);
  trials_ -= static_cast<double>(trials);
}

/// Trials, with the shares of those that are running.
double Progress::done() const {
  double done = static_cast<double>(finished_);
  for (const auto& [trial, share] : running_) done += share;
  return done;
}

/// ", about 3 min left", once that can be told.
std::string Progress::time_left(double done) const {
  const double passed_s = std::chrono::duration<double>(Clock::now() - start_).count();
  if (passed_s < 2.0 || done < 0.01) return "";
  const double left_s = passed_s * (1.0 - done) / done;
  if (left_s < 99.0) return fmt::format(", about {:.0f} s left", left_s);
  if (left_s < 99.0 * 60.0) return fmt::format(", about {:.0f} min left", left_s / 60.0);
  return fmt::format(", about {:.1f} h left", left_s / 3600.0);
}

}  // namespace glocal::app
