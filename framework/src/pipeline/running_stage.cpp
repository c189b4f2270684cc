#include "glocal/running_stage.hpp"

namespace glocal {
namespace {

// Initial-exec: there from the thread's beginning, so that a signal handler need not allocate it.
[[gnu::tls_model("initial-exec")]] thread_local const RunningStage* current = nullptr;

}  // namespace

const RunningStage* running_stage() {
  return current;
}

StageScope::StageScope(const RunningStage* stage) : before_(current) {
  current = stage;
}

StageScope::~StageScope() {
  current = before_;
}

}  // namespace glocal
