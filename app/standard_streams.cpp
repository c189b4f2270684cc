#include "app/standard_streams.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <iostream>

#include "glocal/error.hpp"

namespace glocal::app {

void keep_standard_streams() {
  // In rising order: each takes the lowest number that is free. What is written to one that was closed fails.
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(stream, F_GETFD) == -1 && errno == EBADF)
      static_cast<void>(open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY));
  }
}

void say(const std::string& text) {
  static_cast<void>(std::fputs(text.c_str(), stderr));
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
