#include "app/interrupts.hpp"

#include <atomic>
#include <csignal>

namespace glocal::app {
namespace {

std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free, "set by a signal handler");

void interrupt(int signal) {
  if (interrupted.exchange(true)) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
}

void note_interrupt(int /*signal*/) {
  interrupted = true;
}

}  // namespace

void listen_to_interrupts() {
  std::signal(SIGINT, interrupt);
  std::signal(SIGTERM, interrupt);
}

void listen_to_parent() {
  interrupted = false;
  std::signal(SIGINT, SIG_IGN);
  std::signal(SIGTERM, SIG_IGN);
  std::signal(SIGUSR1, note_interrupt);
}

void interrupt_child(pid_t child) {
  kill(child, SIGUSR1);
}

bool is_interrupted() {
  return interrupted;
}

}  // namespace glocal::app
