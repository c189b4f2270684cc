// Answers on stdout and messages on stderr, wherever they lead: to a full disk, or nowhere.
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>

namespace glocal::app {

/// Makes sure that no file which is opened later takes the place of a standard stream that is closed.
void keep_standard_streams();

/// Writes to stderr. Goes on where that fails: nobody is left to be told.
void say(const std::string& text);
template <class... Values>
void say(fmt::format_string<Values...> text, Values&&... values) {
  say(fmt::format(text, std::forward<Values>(values)...));
}

/// "[####......]", for lines that show how much is done, in [0, 1].
[[nodiscard]] std::string text_bar(double share);

/// Throws RunError if an answer has not reached stdout.
void flush_answers();

}  // namespace glocal::app
