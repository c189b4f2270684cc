#include "glocal/parallel.hpp"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <thread>

#include "cpu_time.hpp"
#include "glocal/running_stage.hpp"

namespace glocal {
namespace {

/// Kept from call to call: threads that have just worked in an arena are still awake there. Each caller has
/// its own: those that run side by side must not wait for each other.
oneapi::tbb::task_arena& arena_of(int threads) {
  // TBB keeps to the number of processors unless it is told otherwise; users may ask for more.
  constexpr std::size_t most_threads = 256;
  static const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism,
                                                 most_threads);
  static thread_local std::map<int, oneapi::tbb::task_arena> arenas;
  return arenas.try_emplace(threads, threads).first->second;
}

/// What is done at the end of a scope, also if something is thrown.
template <class Work>
class AtEnd {
 public:
  explicit AtEnd(Work work) : work_(work) {}
  AtEnd(const AtEnd&) = delete;
  AtEnd& operator=(const AtEnd&) = delete;
  ~AtEnd() { work_(); }

 private:
  Work work_;
};

}  // namespace

void parallel_for(int threads, std::size_t n, const std::function<void(std::size_t)>& work) {
  if (threads <= 1 || n <= 1) {
    for (std::size_t i = 0; i < n; ++i) work(i);
    return;
  }
  end_copies_of_stage();
  oneapi::tbb::task_arena& arena = arena_of(threads);
  // TBB orders these calls and what they throw by itself, but ThreadSanitizer cannot see into it: said once
  // more in terms it knows.
  std::atomic<std::size_t> begun{0};
  std::atomic<std::size_t> done{0};
  begun.store(1, std::memory_order_release);
  const RunningStage* const stage = running_stage();
  const std::thread::id caller = std::this_thread::get_id();
  std::atomic<std::int64_t> of_others_ns{0};
  const AtEnd see_what_is_done([&] { (void)done.load(std::memory_order_acquire); });
  arena.execute([&] {
    oneapi::tbb::parallel_for(std::size_t{0}, n, [&](std::size_t i) {
      (void)begun.load(std::memory_order_acquire);
      const AtEnd hand_over([&] { done.fetch_add(1, std::memory_order_release); });
      const StageScope scope(stage);
      const bool is_other = std::this_thread::get_id() != caller;
      const std::int64_t before = is_other ? cpu_time_ns() : 0;
      work(i);
      if (is_other) of_others_ns.fetch_add(cpu_time_ns() - before, std::memory_order_relaxed);
    });
  });
  add_cpu_time_of_others(of_others_ns.load(std::memory_order_relaxed));
}

void for_bands(int threads, int rows, int together, const std::function<void(int begin, int end)>& work) {
  const int bands = threads > 1 ? 4 * threads : 1;  // some have more to do than others
  const int size = ((rows - 1) / bands / together + 1) * together;
  parallel_for(threads, static_cast<std::size_t>(bands), [&](std::size_t band) {
    const int begin = static_cast<int>(band) * size;
    if (begin < rows) work(begin, std::min(rows, begin + size));
  });
}

}  // namespace glocal
