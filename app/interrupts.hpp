// Ctrl-C and kill, for commands that end in good order.
#pragma once

namespace glocal::app {

/// From now on the first SIGINT or SIGTERM is only noted: whoever works asks, and ends after the step that is
/// under way. The second one ends the program at once.
void listen_to_interrupts();
[[nodiscard]] bool is_interrupted();

}  // namespace glocal::app
