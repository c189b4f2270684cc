// Answers on stdout and messages on stderr, wherever they lead: to a full disk, or nowhere.
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>

namespace glocal::app {

/// Makes sure that no file which is opened later takes the place of a standard stream that is closed.
void keep_standard_streams();

// All that the program prints goes through these, and names that a file brought reach a terminal only as what
// can be printed.

/// Writes to stdout: printable().
void answer(const std::string& text);
template <class... Values>
void answer(fmt::format_string<Values...> text, Values&&... values) {
  answer(fmt::format(text, std::forward<Values>(values)...));
}
/// The same, on a terminal that is cleared before.
void answer_on_cleared_screen(const std::string& text);

/// Writes to stderr: fit_message(). Goes on where that fails: nobody is left to be told.
void say(const std::string& text);
template <class... Values>
void say(fmt::format_string<Values...> text, Values&&... values) {
  say(fmt::format(text, std::forward<Values>(values)...));
}
/// The same, in the place of the terminal's last line; nothing clears it.
void say_over(const std::string& text);

/// Has spdlog write to stderr in the same way: "warning: …". A warning that has been said is not said again.
void log_to_stderr();

/// A warning in that log.
void warn(const std::string& text);

/// "[####......]", for lines that show how much is done, in [0, 1].
[[nodiscard]] std::string text_bar(double share);

/// Throws RunError if an answer has not reached stdout.
void flush_answers();

}  // namespace glocal::app
