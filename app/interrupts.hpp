// Ctrl-C and kill, for commands that end in good order.
#pragma once

#include <sys/types.h>

namespace glocal::app {

/// From now on the first SIGINT or SIGTERM is only noted: whoever works asks, and ends after the step that is
/// under way. The second one ends the program at once.
void listen_to_interrupts();
[[nodiscard]] bool is_interrupted();

/// For a child: only its parent interrupts it, with interrupt_child(), which may be called again and again.
/// What a terminal or a scheduler sends reaches both, and must not count twice.
void listen_to_parent();
void interrupt_child(pid_t child);

}  // namespace glocal::app
