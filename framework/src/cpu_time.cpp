#include "cpu_time.hpp"

#include <ctime>

namespace glocal {
namespace {

thread_local std::int64_t of_others_ns = 0;

}  // namespace

std::int64_t cpu_time_ns() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  constexpr std::int64_t ns_per_s = 1'000'000'000;
  return ns_per_s * time.tv_sec + time.tv_nsec + of_others_ns;
}

void add_cpu_time_of_others(std::int64_t ns) {
  of_others_ns += ns;
}

}  // namespace glocal
