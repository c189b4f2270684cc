// How long processors have worked, which another load of the machine changes less than the time on the wall.
#pragma once

#include <cstdint>

namespace glocal {

/// CPU time of this thread so far, with that of the threads that have worked for it in parallel_for(), ns.
[[nodiscard]] std::int64_t cpu_time_ns();

/// Counts what other threads have worked for this one.
void add_cpu_time_of_others(std::int64_t ns);

}  // namespace glocal
