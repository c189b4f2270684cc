// Work over several threads with the same answer for any number of them.
#pragma once

#include <cstddef>
#include <functional>

namespace glocal {

/// Calls work(0) … work(n - 1), each once, on at most `threads` threads. Calls must not depend on each other,
/// and whatever they produce must be merged in index order. An exception of a call is thrown here.
void parallel_for(int threads, std::size_t n, const std::function<void(std::size_t)>& work);

}  // namespace glocal
