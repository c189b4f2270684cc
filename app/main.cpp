// glocal: finds out where a mobile robot is on a known map from range scans and odometry.
#include <csignal>

#include "app/command_line.hpp"
#include "app/fatal_signals.hpp"
#include "app/standard_streams.hpp"

int main(int argc, char** argv) {
  glocal::app::keep_standard_streams();
  glocal::app::name_strategy_in_crashes();
  // A file that grows over the limit of the shell (ulimit -f) is an error like a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  glocal::app::log_to_stderr();
  return glocal::app::run_program(argc, argv);
}
