// How far the reading of a long recording is, for who is waiting for it.
#pragma once

#include <chrono>

#include "glocal/catalog.hpp"

namespace glocal::app {

/// On a terminal, after the first second, one line that is written over again and again.
class ReadingBar {
 public:
  ReadingBar() = default;
  ~ReadingBar() { clear(); }
  ReadingBar(const ReadingBar&) = delete;
  ReadingBar& operator=(const ReadingBar&) = delete;

  /// To be called with the share that has been read; at 1 the line goes. Good as long as this object is.
  [[nodiscard]] TellProgress call() {
    return [this](double share) { show(share); };
  }

 private:
  using Clock = std::chrono::steady_clock;

  void show(double share);
  void clear();

  Clock::time_point start_ = Clock::now();
  Clock::time_point last_ = start_;
  bool is_shown_ = false;
};

}  // namespace glocal::app
