// Work over several threads with the same answer for any number of them.
#pragma once

#include <cstddef>
#include <functional>

namespace glocal {

/// Calls work(0) … work(n - 1), each once, on at most `threads` threads. Calls must not depend on each other,
/// and whatever they produce must be merged in index order. An exception of a call is thrown here.
void parallel_for(int threads, std::size_t n, const std::function<void(std::size_t)>& work);

/// Cuts rows into bands, and calls work(begin, end) for the rows of each, on at most `threads` threads. So
/// many rows, from the first on, are never cut apart. What is produced must not depend on the bands.
void for_bands(int threads, int rows, int together, const std::function<void(int begin, int end)>& work);

}  // namespace glocal
