#include "python/src/interrupts.hpp"

#include <atomic>
#include <csignal>
#include <mutex>

namespace glocal::python {
namespace {

std::mutex changing;
int at_work = 0;
struct sigaction before {};  ///< What is put back once nobody is at work.
std::atomic<int> noted = 0;
static_assert(std::atomic<int>::is_always_lock_free, "set by a signal handler");

void note(int signal) {
  if (noted++ > 0) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
}

}  // namespace

Interrupts::Interrupts() {
  const std::lock_guard lock(changing);
  if (at_work++ > 0) return;
  noted = 0;
  sigaction(SIGINT, nullptr, &before);
  if (before.sa_handler == SIG_IGN) return;
  struct sigaction action {};
  action.sa_handler = note;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
}

Interrupts::~Interrupts() {
  const std::lock_guard lock(changing);
  if (--at_work == 0) sigaction(SIGINT, &before, nullptr);
}

bool Interrupts::happened() const {
  return noted > 0;
}

}  // namespace glocal::python
