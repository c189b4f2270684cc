#include "app/reading_bar.hpp"

#include <unistd.h>

#include "app/standard_streams.hpp"

namespace glocal::app {

void ReadingBar::show(double share) {
  constexpr std::chrono::seconds short_wait{1};
  constexpr std::chrono::milliseconds pause{100};
  if (share >= 1.0) return clear();
  const auto now = Clock::now();
  if (now - start_ < short_wait || now - last_ < pause || isatty(STDERR_FILENO) != 1) return;
  last_ = now;
  is_shown_ = true;
  say_over(fmt::format("{} reading, {:.0f} %", text_bar(share), 100.0 * share));
}

void ReadingBar::clear() {
  if (is_shown_) say_over("");
  is_shown_ = false;
}

}  // namespace glocal::app
