// What the page of a run that goes on asks for, and what it is told.
#pragma once

#include <httplib.h>
// A macro of <resolv.h>, which httplib brings, and a name of Eigen's.
#undef _res

#include "report/live_run.hpp"

namespace glocal::app {

/// Only programs on this machine reach it.
inline constexpr const char* watch_address = "127.0.0.1";

/// From now on the server answers what the page asks, and nothing else. `port` is the one it listens on.
void answer_watchers(httplib::Server& server, LiveRun& run, int port);

}  // namespace glocal::app
