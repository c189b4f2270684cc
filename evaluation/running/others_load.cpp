#include "evaluation/running/others_load.hpp"

#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <string>

namespace glocal {
namespace {

/// Time that all processors have worked since the machine was started, s.
std::optional<double> busy_seconds() {
  std::ifstream file("/proc/stat");
  std::string name;
  double user = 0.0, nice = 0.0, system = 0.0;
  if (!(file >> name >> user >> nice >> system) || name != "cpu") return std::nullopt;
  return (user + nice + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

/// Time that processors have worked for this process, s.
double own_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

}  // namespace

OthersLoad::OthersLoad() : busy_s_(busy_seconds()), own_s_(own_seconds()) {}

std::optional<double> OthersLoad::mean() const {
  const std::optional<double> busy = busy_seconds();
  const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  // Ticks of 10 ms say nothing of less.
  if (!busy || !busy_s_ || elapsed < 1.0) return std::nullopt;
  return std::max(0.0, (*busy - *busy_s_) - (own_seconds() - own_s_)) / elapsed;
}

}  // namespace glocal
