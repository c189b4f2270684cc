// Ctrl-C while the core works, and Python cannot look.
#pragma once

namespace glocal::python {

/// For as long as one lives, in any thread, the first SIGINT is only noted: whoever works asks, and ends
/// after the step that is under way. The second one ends the process at once, as in the program. Does nothing
/// in a process that ignores SIGINT.
class Interrupts {
 public:
  Interrupts();
  ~Interrupts();
  Interrupts(const Interrupts&) = delete;
  Interrupts& operator=(const Interrupts&) = delete;

  [[nodiscard]] bool happened() const;
};

}  // namespace glocal::python
