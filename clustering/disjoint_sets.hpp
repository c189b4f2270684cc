#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace glocal::clustering {

/// Numbers 0 to n - 1 in sets that can be united (Galler and Fischer 1964); the smallest member names a set.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) : parents_(n) {
    std::iota(parents_.begin(), parents_.end(), std::size_t{0});
  }

  [[nodiscard]] std::size_t find(std::size_t i) {
    while (parents_[i] != i) i = std::exchange(parents_[i], parents_[parents_[i]]);
    return i;
  }

  void unite(std::size_t a, std::size_t b) {
    const auto [smaller, larger] = std::minmax({find(a), find(b)});
    parents_[larger] = smaller;
  }

 private:
  std::vector<std::size_t> parents_;
};

}  // namespace glocal::clustering
