#include "glocal/running_stage.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <unistd.h>

#include <atomic>
#include <string>

namespace glocal {
namespace {

// Initial-exec: there from the thread's beginning, so that a signal handler need not allocate it.
[[gnu::tls_model("initial-exec")]] thread_local const StageScope* current = nullptr;

std::atomic<int> copies = 0;
const int counts_copies = pthread_atfork(nullptr, nullptr, [] { ++copies; });

std::string text_of(const RunningStage& stage) {
  const std::string when = stage.step == RunningStage::before_first
                               ? ""
                               : fmt::format(", trial {}, step {}", stage.trial, stage.step);
  return fmt::format("{} '{}'{}", stage.kind, stage.name, when);
}

}  // namespace

const RunningStage* running_stage() {
  return current == nullptr ? nullptr : current->stage();
}

void end_copies_of_stage() {
  if (current != nullptr) current->end_copies();
}

ProcessMark::ProcessMark() : copies_(copies) {}

void ProcessMark::end_copies() const {
  if (copies == copies_) return;
  const RunningStage* stage = running_stage();
  const std::string line = fmt::format(
      "error: {} has called fork(), and the copy has come back to the run; the copy is ended. What is copied "
      "must call exec or _exit\n",
      stage == nullptr ? "a strategy" : text_of(*stage));
  static_cast<void>(!::write(STDERR_FILENO, line.data(), line.size()));
  // Nothing is unwound: what would be removed or closed is the other process's.
  _exit(1);
}

StageScope::StageScope(const RunningStage* stage) : stage_(stage), before_(current) {
  current = this;
}

StageScope::~StageScope() {
  process_.end_copies();
  current = before_;
}

}  // namespace glocal
