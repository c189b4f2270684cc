// A last word when the program crashes: plugins are native code, and may do anything.
#pragma once

namespace glocal::app {

/// From now on a crash says in one line on stderr which signal it was and which strategy was at work; then
/// the program ends by that signal, as it would have without.
void name_strategy_in_crashes();

}  // namespace glocal::app
