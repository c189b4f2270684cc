#include "glocal/parallel.hpp"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <atomic>

namespace glocal {

void parallel_for(int threads, std::size_t n, const std::function<void(std::size_t)>& work) {
  if (threads <= 1 || n <= 1) {
    for (std::size_t i = 0; i < n; ++i) work(i);
    return;
  }
  // TBB keeps to the number of processors unless it is told otherwise; users may ask for more.
  const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism,
                                          static_cast<std::size_t>(threads));
  oneapi::tbb::task_arena arena(threads);
  // TBB orders these calls by itself, but ThreadSanitizer cannot see into it: said once more in terms it
  // knows.
  std::atomic<std::size_t> begun{0};
  std::atomic<std::size_t> done{0};
  begun.store(1, std::memory_order_release);
  arena.execute([&] {
    oneapi::tbb::parallel_for(std::size_t{0}, n, [&](std::size_t i) {
      (void)begun.load(std::memory_order_acquire);
      work(i);
      done.fetch_add(1, std::memory_order_release);
    });
  });
  (void)done.load(std::memory_order_acquire);
}

}  // namespace glocal
