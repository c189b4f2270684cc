#include "log_lines.hpp"

#include <dds/dds.h>

#include <mutex>
#include <string_view>
#include <utility>

namespace glocal::ros2_plugin {
namespace {

std::mutex takers_mutex;
std::list<LogLines::Take> takers;

void on_line(void* /*unused*/, const dds_log_data_t* logged) {
  std::string_view line(logged->message, logged->size);
  // What is no message of its type: its number would make each one another line.
  const std::size_t undone = line.find("deserialization ");
  if (undone != std::string_view::npos) line.remove_prefix(undone);
  const std::lock_guard lock(takers_mutex);
  for (const LogLines::Take& take : takers) take(std::string(line.substr(0, line.find('\n'))));
}

}  // namespace

LogLines::LogLines(Take take) {
  bool is_first = false;
  {
    const std::lock_guard lock(takers_mutex);
    is_first = takers.empty();
    place_ = takers.insert(takers.end(), std::move(take));
  }
  // Not within the lock: Cyclone waits for lines that are being taken.
  if (is_first) dds_set_log_sink(on_line, nullptr);
}

LogLines::~LogLines() {
  bool was_last = false;
  {
    const std::lock_guard lock(takers_mutex);
    takers.erase(place_);
    was_last = takers.empty();
  }
  if (was_last) dds_set_log_sink(nullptr, nullptr);
}

}  // namespace glocal::ros2_plugin
