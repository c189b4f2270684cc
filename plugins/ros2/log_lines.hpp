// What Cyclone would print.
#pragma once

#include <functional>
#include <list>
#include <string>

namespace glocal::ros2_plugin {

/// Takes the lines of Cyclone's log, which is one for all of a program, as long as it lives. As long as none
/// does, Cyclone prints them.
class LogLines {
 public:
  using Take = std::function<void(std::string line)>;

  /// Calls come from any thread.
  explicit LogLines(Take take);
  LogLines(const LogLines&) = delete;
  LogLines& operator=(const LogLines&) = delete;
  ~LogLines();

 private:
  std::list<Take>::iterator place_;
};

}  // namespace glocal::ros2_plugin
