#include "glocal/parallel.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "cpu_time.hpp"
#include "files.hpp"

namespace glocal::test::parallel_test {
namespace {

constexpr std::size_t many = 1000;

TEST(ParallelFor, CallsEachOnce) {
  for (const int threads : {-1, 0, 1, 2, 7, 64}) {
    std::vector<int> calls(many, 0);
    parallel_for(threads, many, [&](std::size_t i) { ++calls[i]; });
    EXPECT_EQ(calls, std::vector<int>(many, 1)) << threads;
  }
}

TEST(ParallelFor, DoesNothingWithoutWork) {
  for (const int threads : {1, 4}) {
    parallel_for(threads, 0, [](std::size_t) { ADD_FAILURE() << "there is no work"; });
    // Nor does it need any function then.
    EXPECT_NO_THROW(parallel_for(threads, 0, {}));
  }
}

/// Works for this long in time of a processor.
void burn(double ms) {
  const std::int64_t begin = cpu_time_ns();
  while (static_cast<double>(cpu_time_ns() - begin) < 1e6 * ms) {
  }
}

/// The least time of a processor that work takes: threads that begin, and a host that takes the processor
/// away, only add to it.
double least_ms(const std::function<void()>& work) {
  std::int64_t least = std::numeric_limits<std::int64_t>::max();
  for (int i = 0; i < 5; ++i) {
    const std::int64_t begin = cpu_time_ns();
    work();
    least = std::min(least, cpu_time_ns() - begin);
  }
  return 1e-6 * static_cast<double>(least);
}

TEST(ParallelFor, CountsTheTimeOfAllProcessors) {
  for (const int threads : {1, 2, 4}) {
    const double ms = least_ms([&] { parallel_for(threads, 20, [](std::size_t) { burn(2.0); }); });
    EXPECT_GE(ms, 40.0) << threads;
#ifndef __SANITIZE_THREAD__  // Threads that wake take ThreadSanitizer tens of milliseconds of its own.
    // Not much besides, and nothing twice.
    EXPECT_LT(ms, 60.0) << threads;
#endif
  }
}

TEST(ForBands, TakeEachRowOnceAndCutNoneApart) {
  for (const int threads : {1, 2, 3}) {
    for (const int rows : {1, 31, 32, 33, 1000}) {
      for (const int together : {1, 32}) {
        std::vector<int> taken(static_cast<std::size_t>(rows));
        for_bands(threads, rows, together, [&](int begin, int end) {
          EXPECT_LT(begin, end);
          EXPECT_EQ(begin % together, 0);
          for (int row = begin; row < end; ++row) ++taken[static_cast<std::size_t>(row)];
        });
        EXPECT_THAT(taken, testing::Each(1)) << threads << " " << rows << " " << together;
      }
    }
  }
}

TEST(ParallelFor, CountsNoTimeOfWaiting) {
  const auto wait = [](std::size_t) { std::this_thread::sleep_for(std::chrono::milliseconds(20)); };
  EXPECT_LT(least_ms([&] { parallel_for(2, 4, wait); }), 15.0);
}

TEST(ParallelFor, ThrowsWhatACallThrows) {
  for (const int threads : {1, 4}) {
    const auto work = [](std::size_t i) {
      if (i == 500) throw std::runtime_error("number " + std::to_string(i));
    };
    EXPECT_EQ(test::error_of<std::runtime_error>([&] { parallel_for(threads, many, work); }), "number 500")
        << threads << " threads";
  }
}

TEST(ParallelFor, ThrowsOnceIfAllCallsThrow) {
  for (const int threads : {1, 4}) {
    std::atomic<std::size_t> calls = 0;
    const auto work = [&](std::size_t i) {
      ++calls;
      throw i;
    };
    EXPECT_THROW(parallel_for(threads, many, work), std::size_t);
    EXPECT_GE(calls, 1U);
    EXPECT_LE(calls, many);
  }
}

TEST(ParallelFor, WorksAfterAnException) {
  const auto fail = [](std::size_t) { throw std::runtime_error("no"); };
  EXPECT_THROW(parallel_for(4, many, fail), std::runtime_error);
  std::vector<std::size_t> squares(many);
  parallel_for(4, many, [&](std::size_t i) { squares[i] = i * i; });
  EXPECT_EQ(squares[many - 1], (many - 1) * (many - 1));
}

TEST(ParallelFor, MayBeCalledInsideOfItself) {
  std::vector<std::size_t> sums(20, 0);
  parallel_for(4, sums.size(), [&](std::size_t i) {
    std::vector<std::size_t> parts(50);
    parallel_for(2, parts.size(), [&](std::size_t k) { parts[k] = i; });
    sums[i] = std::accumulate(parts.begin(), parts.end(), std::size_t{0});
  });
  for (std::size_t i = 0; i < sums.size(); ++i) EXPECT_EQ(sums[i], 50 * i);
}

}  // namespace
}  // namespace glocal::test::parallel_test
