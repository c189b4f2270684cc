#include "evaluation/sharding/shares.hpp"

#include <algorithm>
#include <numeric>
#include <queue>
#include <tuple>

namespace glocal {
namespace {

/// Numbers of the trials, the longest first.
std::vector<std::size_t> longest_first(const std::vector<std::size_t>& steps) {
  std::vector<std::size_t> order(steps.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return steps[a] > steps[b]; });
  return order;
}

/// What a shard has: of this variant, of all, and which it is. The least one is served next.
using Load = std::tuple<std::size_t, std::size_t, std::size_t>;

}  // namespace

std::vector<PlannedTrial> share_of(const std::vector<std::vector<std::size_t>>& steps, const Shard& shard) {
  std::vector<std::size_t> all(shard.of, 0);  // Steps of each shard.
  std::vector<PlannedTrial> share;
  for (std::size_t variant = 0; variant < steps.size(); ++variant) {
    std::priority_queue<Load, std::vector<Load>, std::greater<>> loads;
    for (std::size_t k = 0; k < shard.of; ++k) loads.emplace(0, all[k], k);
    const std::size_t begin = share.size();
    for (const std::size_t trial : longest_first(steps[variant])) {
      const auto [of_variant, of_all, k] = loads.top();
      loads.pop();
      all[k] += steps[variant][trial];
      loads.emplace(of_variant + steps[variant][trial], all[k], k);
      if (k + 1 == shard.number) share.push_back({variant, trial});
    }
    std::sort(share.begin() + static_cast<std::ptrdiff_t>(begin), share.end(),
              [](const PlannedTrial& a, const PlannedTrial& b) { return a.trial < b.trial; });
  }
  return share;
}

}  // namespace glocal
